//! From the given keys to a bearing in a housing: defaults, and checks between keys.

use crate::ch2_housing::bore_contact::Penalty;
use crate::ch4_rotor::bore_friction::{BoreFriction, COEFFICIENT, STRETCH};
use crate::equilibrium::statics::COORDINATE_NAMES;
use crate::members::body::{Drive, DrivenBody, Rotation};
use crate::motion::simulation::Start;
use crate::numeric::profile::Profile;
use crate::plan::channels::ChannelGroup;
use crate::scene::build::assembly::PlacedHousing;
use crate::scene::error::{Problem, SceneError};
use crate::scene::resolve::bearing::{Reader, resolve_bearing, text};
use crate::scene::resolve::housing_scene::{FitSize, HousingMethod, HousingSettings};
use crate::scene::resolve::resolved::{Plot, RunPlot, Scene};
use crate::scene::resolve::solid::housing_solid;
use crate::scene::text::document::{Assumption, Document};
use crate::scene::text::units::plain;
use crate::scene::text::value::Checked;
use crate::solids::bore_equilibrium::Axial;

/// Largest fit, as a fraction of the outer race's radius: ten times any real one.
const LARGEST_FIT: f64 = 0.01;

/// A bearing and its flexible housing; `None` for a rigid one.
///
/// # Errors
///
/// The first key, in a fixed order, that is missing or contradicts others.
pub(crate) fn in_housing(
    document: &Document,
) -> Result<(Scene, Option<PlacedHousing>), SceneError> {
    let mut bearing = resolve_bearing(document)?;
    let mut reader = Reader::new(document);
    let method = reader.choice("housing.method").unwrap_or("quasi-static");
    if method == "rigid" {
        // Errors in it are reported for every method.
        if document.first_below("solid").is_some() {
            housing_solid(document)?;
        }
        refuse_drives(document, &bearing)?;
        bearing.dynamics.outer = None;
        bearing.dynamics.defaults_used.retain(|used| !used.key.starts_with("outer_race."));
        bearing.rigid_housing = true;
        bearing.assumptions.push(Assumption {
            name: "housing.method = rigid".into(),
            text: "the outer race is fixed; the housing's mesh is not read".into(),
        });
        return Ok((bearing, None));
    }
    let method = match method {
        "explicit" => HousingMethod::Explicit,
        "reduced" => HousingMethod::Reduced,
        _ => HousingMethod::QuasiStatic,
    };
    if document.first_below("solid").is_none() {
        let because = ", a housing is a solid".to_string();
        let [solid, housing] = ["solid", "housing"].map(|table| document.shown(table, true));
        let example = format!("a [{solid}.mesh] table, or method = \"rigid\" to [{housing}]");
        return Err(document.error_here("solid", Problem::Missing { because, example }));
    }
    let friction = friction(&mut reader, method)?;
    refuse_motion(document, &reader, friction.is_some())?;
    let solid = housing_solid(document)?;
    let end = bearing.dynamics.run.as_ref().map(|run| run.end);
    let housing = settings(&mut reader, &bearing, method, (friction, end))?;
    match method {
        HousingMethod::QuasiStatic => refuse_inertia(document, &bearing)?,
        HousingMethod::Reduced => refuse_start(document, &bearing)?,
        HousingMethod::Explicit => {}
    }
    rest(document, &mut bearing, &housing)?;
    output(document, &reader, &mut bearing, method)?;
    let defaults_used = reader.into_defaults_used();
    let settings = HousingSettings { defaults_used, ..housing };
    Ok((bearing, Some(PlacedHousing { settings, solid })))
}

fn not_applicable<T>(
    document: &Document,
    key: &str,
    reason: &'static str,
    advice: &str,
) -> Result<T, SceneError> {
    Err(document.refused(key, reason, advice))
}

/// Friction of the bore; `None` without any, or with a coefficient of zero.
fn friction(
    reader: &mut Reader,
    method: HousingMethod,
) -> Result<Option<BoreFriction>, SceneError> {
    let [law, coefficient, stretch] =
        ["law", "coefficient", "stretch"].map(|key| format!("housing.friction.{key}"));
    if reader.choice_if_given(&law) != Some("stick-slip") {
        let Some(key) = [coefficient, stretch].into_iter().find(|key| reader.is_given(key)) else {
            return Ok(None);
        };
        let reason = "without a law the bore is smooth";
        let advice = "add law = \"stick-slip\", or leave it out";
        return not_applicable(reader.document, &key, reason, advice);
    }
    if method != HousingMethod::Explicit {
        let reason = "the springs of friction have a history, which needs the steps of `explicit`";
        let advice = "leave `friction` out, or write method = \"explicit\"";
        return not_applicable(reader.document, &law, reason, advice);
    }
    let coefficient = reader.number(&coefficient).unwrap_or(COEFFICIENT);
    let stretch = reader.number(&stretch).unwrap_or(STRETCH);
    Ok((coefficient != 0.0).then_some(BoreFriction { coefficient, stretch }))
}

/// The race must be free to move without another support; a rotating one needs friction.
fn refuse_motion(document: &Document, reader: &Reader, rough: bool) -> Result<(), SceneError> {
    let key = "outer_race.motion";
    match reader.choice_if_given(key) {
        Some("5-dof") => {}
        Some("6-dof") if rough => {}
        Some("6-dof") => {
            let reason = "the bore has no friction, so nothing would keep the race from turning";
            let advice = "write motion = \"5-dof\", or friction.law = \"stick-slip\" in [housing]";
            return not_applicable(document, key, reason, advice);
        }
        _ => {
            let reason = "a fixed outer race does not move in its housing";
            let [race, housing] =
                ["outer_race", "housing"].map(|table| document.shown(table, true));
            let advice = format!(
                "write motion = \"5-dof\" in [{race}], or method = \"rigid\" in [{housing}]"
            );
            return Err(document.error_here(key, Problem::refused(reason, advice)));
        }
    }
    if let Some(key) = document.first_below("outer_race.foundation") {
        let reason = "the outer race is on a foundation or in a housing, not both";
        return not_applicable(document, key, reason, "leave out [housing], or the foundation");
    }
    Ok(())
}

/// Refuses loads and motions of an outer race that a rigid housing fixes.
fn refuse_drives(document: &Document, bearing: &Scene) -> Result<(), SceneError> {
    const FIXED: &str = "a rigid housing fixes the outer race";
    const ADVICE: &str = "leave it out, or choose another method";
    let Some(outer) = &bearing.dynamics.outer else { return Ok(()) };
    if matches!(&outer.rotation, Rotation::Speed(speed) if !speed.is_zero()) {
        return not_applicable(document, "outer_race.speed", FIXED, ADVICE);
    }
    for (name, drive) in COORDINATE_NAMES.iter().zip(&outer.drives) {
        let moves =
            matches!(drive, Drive::Motion(profile) if !matches!(profile, Profile::Constant(_)));
        if moves {
            return not_applicable(document, &drive_key(name, false), FIXED, ADVICE);
        }
    }
    Ok(())
}

fn drive_key(name: &str, load: bool) -> String {
    let tilt = name.starts_with("tilt");
    let kind = match (tilt, load) {
        (true, true) => "moment",
        (true, false) => "tilt",
        (false, true) => "load",
        (false, false) => "displacement",
    };
    format!("outer_race.{name}.{kind}")
}

/// Start of explicit steps in equilibrium or not; refuses keys without effect.
fn start(reader: &mut Reader, method: HousingMethod) -> Result<bool, SceneError> {
    let key = "housing.start";
    if method != HousingMethod::Explicit {
        if reader.is_given(key) {
            let reason = "equilibria and reduced housings always start in equilibrium";
            return not_applicable(reader.document, key, reason, "leave it out");
        }
        return Ok(false);
    }
    let from_equilibrium = reader.choice(key) == Some("equilibrium");
    if from_equilibrium && reader.is_given("housing.fit_ramp") {
        let reason = "a start in equilibrium includes the fit";
        return not_applicable(reader.document, "housing.fit_ramp", reason, "leave it out");
    }
    Ok(from_equilibrium)
}

fn settings(
    reader: &mut Reader,
    bearing: &Scene,
    method: HousingMethod,
    (friction, end): (Option<BoreFriction>, Option<f64>),
) -> Result<HousingSettings, SceneError> {
    let document = reader.document;
    let bore = text(document, "housing.bore").unwrap_or_else(|| {
        reader.note_default("housing.bore");
        "bore".to_string()
    });
    let fit = fit(reader, bearing)?;
    let grows = match fit {
        FitSize::Interference(interference) => interference > 0.0,
        FitSize::OuterRadius(_) => true,
    };
    let from_equilibrium = start(reader, method)?;
    let ramps = grows && method == HousingMethod::Explicit && !from_equilibrium;
    let fit_ramp = reader.given_number("housing.fit_ramp").or_else(|| {
        let ramp = 0.1 * end.filter(|_| ramps)?;
        let reason = "an interference grows in over a tenth of the run, as in section 2.4.1";
        reader.note("housing.fit_ramp", &format!("{} s", plain(ramp)), reason);
        Some(ramp)
    });
    let width = reader.given_number("housing.width").or_else(|| {
        let length = bearing.dimensions.length;
        let (value, reason) = match length {
            Some(length) => (format!("{} mm", plain(1e3 * length)), "the bearing's length"),
            None => ("that of the bore".to_string(), "without it and `bearing.length`"),
        };
        reader.note("housing.width", &value, reason);
        length
    });
    let (unless_given, reason) = match friction {
        Some(_) => ("free", "friction supports the race along its axis"),
        None => ("fixed", "a shoulder or ring beside the bore; the bore has no friction"),
    };
    let axial = reader.choice_if_given("housing.axial").unwrap_or_else(|| {
        reader.note("housing.axial", unless_given, reason);
        unless_given
    });
    let axial = if axial == "free" { Axial::Free } else { Axial::Fixed };
    let penalty = match document.value("housing.contact.stiffness") {
        Some(Checked::Either(0, stiffness)) => Penalty::PerArea(*stiffness),
        Some(Checked::Either(_, stiffness)) => Penalty::PerNode(*stiffness),
        _ => {
            reader.note_default("housing.contact.stiffness");
            Penalty::default()
        }
    };
    let (mut step_fraction, mut coupling_phase) = (0.8, 0.125);
    for (key, value) in [
        ("housing.step_fraction", &mut step_fraction),
        ("housing.coupling_phase", &mut coupling_phase),
    ] {
        if method == HousingMethod::Explicit {
            *value = reader.number(key).unwrap_or(*value);
        } else if reader.is_given(key) {
            let reason = "only `explicit` has such steps";
            return not_applicable(
                document,
                key,
                reason,
                "leave it out, or write method = \"explicit\"",
            );
        }
    }
    let [modes_to, bore_load] =
        ["housing.modes_to", "housing.bore_load"].map(|key| reader.given_number(key));
    let of_shapes = [("housing.modes_to", modes_to), ("housing.bore_load", bore_load)];
    if let Some((key, _)) = of_shapes.into_iter().find(|(_, given)| given.is_some())
        && method != HousingMethod::Reduced
    {
        let reason = "only `reduced` has modes";
        return not_applicable(
            document,
            key,
            reason,
            "leave it out, or write method = \"reduced\"",
        );
    }
    Ok(HousingSettings {
        from_equilibrium,
        method,
        bore,
        fit,
        fit_ramp,
        width,
        axial,
        penalty,
        friction,
        step_fraction,
        coupling_phase,
        modes_to,
        bore_load,
        defaults_used: Vec::new(),
    })
}

/// The fit as given; a transition fit by default.
fn fit(reader: &mut Reader, bearing: &Scene) -> Result<FitSize, SceneError> {
    let document = reader.document;
    let groove = bearing.dimensions.outer_race.radius;
    let radial = reader.given_number("housing.fit.radial").map(|fit| ("housing.fit.radial", fit));
    let diametral = reader
        .given_number("housing.fit.diametral")
        .map(|fit| ("housing.fit.diametral", 0.5 * fit));
    let radius = reader.given_number("housing.outer_radius");
    match (radial.or(diametral), radius) {
        (Some((key, _)), Some(_)) => {
            let advice = "keep the fit or the radius; each follows from the other".into();
            Err(document
                .error(key, Problem::Exclusive { rival: "housing.outer_radius".into(), advice }))
        }
        (Some((key, fit)), None) => {
            let limit = LARGEST_FIT * groove;
            if fit.abs() <= limit {
                return Ok(FitSize::Interference(fit));
            }
            Err(document.error(key, Problem::FitTooLarge { fit, limit }))
        }
        (None, Some(radius)) => {
            if radius > groove {
                return Ok(FitSize::OuterRadius(radius));
            }
            let problem = Problem::WrongOrder {
                value: radius,
                relation: "more than",
                other_name: "the outer race's groove bottom",
                other: groove,
                advice: "it is the outside of the race",
            };
            Err(document.error("housing.outer_radius", problem))
        }
        (None, None) => {
            reader.note("housing.fit", "{ radial = 0 um }", "a transition fit");
            Ok(FitSize::Interference(0.0))
        }
    }
}

/// Refuses loads that need inertia in a quasi-static sequence.
fn refuse_inertia(document: &Document, bearing: &Scene) -> Result<(), SceneError> {
    const ADVICE: &str = "leave it out, or write method = \"explicit\" in [housing]";
    let Some(outer) = &bearing.dynamics.outer else { return Ok(()) };
    for (i, (name, drive)) in COORDINATE_NAMES.iter().zip(&outer.drives).enumerate() {
        match drive {
            Drive::Motion(_) if i > 0 => {
                let reason = "in equilibrium the housing determines the position of the outer race";
                return not_applicable(document, &drive_key(name, false), reason, ADVICE);
            }
            Drive::Load(load) if i > 2 && !load.is_zero() => {
                let reason = "a quasi-static outer race takes forces, not moments";
                return not_applicable(document, &drive_key(name, true), reason, ADVICE);
            }
            Drive::Load(load) if !matches!(load, Profile::Constant(_)) => {
                let reason = "a quasi-static outer race takes constant loads";
                return not_applicable(document, &drive_key(name, true), reason, ADVICE);
            }
            _ => {}
        }
    }
    if matches!(bearing.dynamics.inner.rotation, Rotation::Torque(_)) {
        let reason = "without inertia no speed follows from a torque";
        return not_applicable(document, "inner_race.torque", reason, "give inner_race.speed");
    }
    if bearing.dynamics.unbalance != 0.0 {
        let reason = "an unbalance needs inertia";
        return not_applicable(document, "inner_race.unbalance", reason, ADVICE);
    }
    for list in ["bearing.dent", "bearing.spall", "bearing.waviness"] {
        if document.items(list).next().is_some() {
            let reason = "an equilibrium has ideal races and balls only";
            return not_applicable(document, list, reason, ADVICE);
        }
    }
    for key in ["bearing.ball.deviations", "bearing.ball.scatter"] {
        if document.value(key).is_some() {
            let reason = "an equilibrium has equal balls only";
            return not_applicable(document, key, reason, ADVICE);
        }
    }
    Ok(())
}

/// Refuses what the equilibrium at the start of a reduced housing cannot have.
fn refuse_start(document: &Document, bearing: &Scene) -> Result<(), SceneError> {
    const ADVICE: &str = "leave it out, or write start = \"nominal\" in [numerics]";
    let (Some(outer), Some(run)) = (&bearing.dynamics.outer, &bearing.dynamics.run) else {
        return Ok(());
    };
    if run.options.start == Start::Nominal {
        return Ok(());
    }
    for (i, (name, drive)) in COORDINATE_NAMES.iter().zip(&outer.drives).enumerate() {
        match drive {
            Drive::Motion(_) if i > 0 => {
                let reason = "in the equilibrium of the start the housing determines the position of the outer race";
                return not_applicable(document, &drive_key(name, false), reason, ADVICE);
            }
            Drive::Load(load) if i > 2 && load.value(0.0) != 0.0 => {
                let reason =
                    "in the equilibrium of the start the outer race takes forces, not moments";
                return not_applicable(document, &drive_key(name, true), reason, ADVICE);
            }
            _ => {}
        }
    }
    Ok(())
}

/// Fixes the axial position of a race with an axial support, and drops the defaults of a free one.
/// of a race that nothing holds.
fn rest(
    document: &Document,
    bearing: &mut Scene,
    housing: &HousingSettings,
) -> Result<(), SceneError> {
    let nominal =
        bearing.dynamics.run.as_ref().is_some_and(|run| run.options.start == Start::Nominal);
    if nominal && housing.method == HousingMethod::Explicit {
        let reason = "in a housing inner race and balls start in equilibrium with the outer race in its nominal position";
        return not_applicable(document, "numerics.start", reason, "leave it out");
    }
    let start = bearing.outer_race[0];
    let Some(DrivenBody { drives, .. }) = &mut bearing.dynamics.outer else { return Ok(()) };
    let mut said = vec!["outer_race.foundation"];
    if housing.axial == Axial::Fixed
        && let Drive::Load(load) = &drives[0]
    {
        if !load.is_zero() && housing.method != HousingMethod::QuasiStatic {
            let reason = "a support beside the bore fixes the race along its axis";
            let advice = "leave it out, or write axial = \"free\" in [housing]";
            return not_applicable(document, "outer_race.x.load", reason, advice);
        }
        drives[0] = Drive::Motion(Profile::Constant(start));
        said.push("outer_race.x");
    }
    bearing.dynamics.defaults_used.retain(|used| !said.contains(&used.key.as_str()));
    Ok(())
}

/// Available plots and columns: statics draws the load zone only, since the other plots would move the bearing and the
/// housing; equilibria have neither cage nor slip.
fn output(
    document: &Document,
    reader: &Reader,
    bearing: &mut Scene,
    method: HousingMethod,
) -> Result<(), SceneError> {
    let steps = bearing.dynamics.run.is_some() && method != HousingMethod::QuasiStatic;
    let drawn = |plot: &Plot| match plot {
        Plot::LoadZone => true,
        // A run in steps has its own plots.
        Plot::Polar => steps,
        Plot::MomentTilt => false,
    };
    let in_run = |plot: &RunPlot| steps || !matches!(plot, RunPlot::SlipSpin | RunPlot::RunUp);
    let all = bearing.plots.iter().all(drawn) && bearing.dynamics.plots.iter().all(in_run);
    if reader.is_given("output.plots") && !all {
        let reason = "in a housing statics draws `load-zone`, equilibria over time `orbit`, \
                      `series` and `spectrum`";
        let advice = "leave the others out, or write method = \"explicit\" in [housing] for `polar`, \
                      `slip-spin` and `run-up`";
        return not_applicable(document, "output.plots", reason, advice);
    }
    bearing.plots.retain(drawn);
    bearing.dynamics.plots.retain(in_run);
    let Some(run) = &mut bearing.dynamics.run else { return Ok(()) };
    if method != HousingMethod::QuasiStatic {
        return Ok(());
    }
    use ChannelGroup::{Energy, Forces, Loads, Races};
    // Always present for both bodies.
    let mut channels = vec![Races, Forces, Energy];
    if reader.is_given("output.channels")
        && !run.channels.iter().all(|group| *group == Loads || channels.contains(group))
    {
        let reason = "equilibria have `races`, `loads`, `forces` and `energy`";
        let advice = "leave the others out, or write method = \"explicit\" in [housing]";
        return not_applicable(document, "output.channels", reason, advice);
    }
    if run.channels.contains(&Loads) {
        channels.push(Loads);
    }
    channels.sort();
    run.channels = channels;
    Ok(())
}
