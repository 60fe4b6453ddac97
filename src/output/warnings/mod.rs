//! Warnings: a code for scripts and tests, and a text for people.
//!
//! A warning exists only if an engineer would change something because of it. `docs/warnings.md` is generated from [`TABLE`].

pub mod solid;

use serde::{Serialize, Serializer};
use std::fmt;

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Warning {
    pub code: WarningCode,
    pub text: String,
}

impl Warning {
    pub fn new(code: WarningCode, text: impl Into<String>) -> Warning {
        Warning { code, text: text.into() }
    }

    /// The warning with its subject in front of the text, such as "bearing left: ".
    pub fn named(self, name: &str) -> Warning {
        Warning { text: format!("{name}{}", self.text), ..self }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "warning[{}]: {}", self.code.name(), self.text)
    }
}

pub fn lines(warnings: &[Warning]) -> String {
    warnings.iter().map(|warning| format!("{warning}\n")).collect()
}

/// Warning codes in the order of [`TABLE`]; the number is part of the code.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum WarningCode {
    IndeterminatePosition = 1,
    SaddleLeft,
    PressureAboveRating,
    ContactPastShoulder,
    LoadOnOpenSide,
    CentrifugalForceLeftOut,
    RowsTooFarApart,
    MeshTooCoarse,
    FourNodeLocking,
    StressAboveElastic,
    RubberVolume,
    ChainsNearFullLength,
    FewContactNodes,
    BushingBeyondFit,
    ExcitationFasterThanFit,
    BeyondKeptModes,
    WhirlUnstable,
    PictureNotDrawn,
    StillSettling,
}

impl WarningCode {
    pub fn number(self) -> usize {
        self as usize
    }

    /// Code such as `W07-rows-too-far-apart`.
    pub fn name(self) -> &'static str {
        TABLE[self.number() - 1].name
    }
}

impl Serialize for WarningCode {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

#[derive(Clone, Copy, Debug)]
pub struct Entry {
    pub name: &'static str,
    pub title: &'static str,
    pub meaning: &'static str,
    pub action: &'static str,
}

pub const TABLE: [Entry; 19] = [
    Entry {
        name: "W01-indeterminate-position",
        title: "Position not determined",
        meaning: "A body has no stiffness in some directions, so its position in these directions is arbitrary. \
         Frequencies and stiffnesses in them are zero.",
        action: "Load or preload the bearing, add a spring, or prescribe these coordinates.",
    },
    Entry {
        name: "W02-saddle-left",
        title: "Unstable equilibrium left",
        meaning: "The first equilibrium found was a saddle point of the energy, and the search went on to a stable one next to it. The mirror \
                  image of the result is an equilibrium too.",
        action: "A race under radial load buckles to one side if its tilts are free: where shaft and housing keep it upright, \
                 fix them (`tilt_y = { tilt = \"0 deg\" }`, `tilt_z` likewise). If the sign of the displacement \
                 matters, add a small load that selects one side.",
    },
    Entry {
        name: "W03-pressure-above-rating",
        title: "Contact pressure above 4200 MPa",
        meaning: "The largest Hertz pressure exceeds 4200 MPa, at which ISO 76 expects permanent deformation of ball and raceway. The model \
                  is elastic.",
        action: "Check loads, speeds, clearance and their units. If the pressure occurs between two balls, add a \
         cage: nothing else keeps them apart.",
    },
    Entry {
        name: "W04-contact-past-shoulder",
        title: "Contact ellipse past the shoulder",
        meaning: "A contact ellipse extends past the edge of its groove. The groove of the model has no edge: the load there is overestimated, \
                  and the edge pressure is not computed.",
        action: "Reduce load or tilt. If the shoulder height was estimated, give `shoulder_radius` of the race.",
    },
    Entry {
        name: "W05-load-on-open-side",
        title: "Load on the open side of an angular-contact bearing",
        meaning: "A ball carries load at a negative contact angle, where the real groove has no shoulder. The real bearing would come apart \
                  there.",
        action: "Preload the bearing along +x (-x if it is `reversed`), or turn it round with `reversed`.",
    },
    Entry {
        name: "W06-centrifugal-force-left-out",
        title: "Centrifugal force of the balls left out",
        meaning: "At this speed the centrifugal force of a ball is more than 5 % of the largest ball load, but the equilibrium does not include it.",
        action: "Write `ball_forces.centrifugal = true`.",
    },
    Entry {
        name: "W07-rows-too-far-apart",
        title: "Output interval too long for an excitation",
        meaning: "The table has fewer than two rows per period of an excitation. Means, amplitudes and spectra of \
                  the rows are aliased.",
        action: "Shorten `numerics.output_interval`; eight rows per period are enough.",
    },
    Entry {
        name: "W08-mesh-too-coarse",
        title: "Mesh too coarse",
        meaning: "The estimate of Zienkiewicz and Zhu, from the stress jumps between elements, gives an error of \
         displacements or frequencies above 2 %. Stresses are less accurate than that.",
        action: "Refine the mesh at high stresses and in walls with fewer than three elements, or write `order = 2` for ten-node \
                 elements.",
    },
    Entry {
        name: "W09-four-node-locking",
        title: "Four-node elements of a nearly incompressible material",
        meaning: "Four-node elements lock from Poisson's ratio 0.45 on: displacements may be a fraction of the true \
         ones even on fine meshes. A bushing with `method = \"explicit\"` uses such elements.",
        action: "Write `order = 2` in the mesh table. For a bushing write `method = \"implicit\"`.",
    },
    Entry {
        name: "W10-stress-above-elastic",
        title: "Stress outside the linear-elastic range",
        meaning: "The von Mises stress exceeds 1 % of Young's modulus. No steel stays elastic there, and the linear material law is valid for small \
                  strains only.",
        action: "Check loads, units and material.",
    },
    Entry {
        name: "W11-rubber-volume",
        title: "Volume of rubber changed by more than 10 %",
        meaning: "The material law of the elastomer is valid for volume changes of a few per cent.",
        action: "Check displacements, loads and the bulk modulus.",
    },
    Entry {
        name: "W12-chains-near-full-length",
        title: "Chains of the network near their full length",
        meaning: "Chains are stretched beyond 0.8 of their full length, where the five-term series is more than 10 % softer than the inverse \
                  Langevin function.",
        action: "Compare with `chain_force = \"inverse-langevin\"`.",
    },
    Entry {
        name: "W13-few-contact-nodes",
        title: "Few bore nodes in contact",
        meaning: "Fewer than 40 nodes of the bore are in contact with the race, so the contact stiffness depends on the mesh.",
        action: "Refine the mesh around and along the bore until displacements and frequencies no longer change.",
    },
    Entry {
        name: "W14-bushing-beyond-fit",
        title: "Bushing displaced beyond the range of its fit",
        meaning: "The springs of a bushing are fitted to small vibrations. At this displacement they are more than 2 % off.",
        action: "Reduce the displacement, or solve the bushing in elements: `method = \"implicit\"`.",
    },
    Entry {
        name: "W15-excitation-faster-than-fit",
        title: "Excitation above the fitted frequencies of a bushing",
        meaning: "An excitation has a higher frequency than the highest one to which the springs of a bushing are \
         fitted. Above that frequency the stiffness of the springs no longer increases.",
        action: "Raise `spring.NAME.bushing.fastest`.",
    },
    Entry {
        name: "W16-beyond-kept-modes",
        title: "Load on a bore beyond its static correction modes",
        meaning: "The load on the bore of a reduced housing exceeds the load for which its static correction modes \
         were computed.",
        action: "Raise `housing.bore_load`.",
    },
    Entry {
        name: "W17-whirl-unstable",
        title: "Unstable whirl",
        meaning: "A whirl mode has negative damping at the speed of the scene and grows, by internal damping above a critical speed or by springs whose `yz` and `zy` differ.",
        action: "Reduce the speed, the internal damping or the difference between `yz` and `zy` of a spring, or add damping that does not rotate.",
    },
    Entry {
        name: "W18-picture-not-drawn",
        title: "Picture not drawn",
        meaning: "A picture varies the scene's positions or tilts, and found no equilibrium at one of them. All results are written.",
        action: "Take the picture out of `output.plots`, or fix coordinates that no load determines.",
    },
    Entry {
        name: "W19-still-settling",
        title: "Motion still settling",
        meaning: "Loads and speeds are constant over the window, which has ten turns of the inner race or more. The mean position \
         of the inner race nevertheless changes from its first half to its second by more than it oscillates. Means and spectra of \
         the window are not those of the settled motion.",
        action: "Lengthen the run (`numerics.end`) and start the window later (`output.window_start`).",
    },
];
