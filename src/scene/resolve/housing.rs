//! From the given keys to a bearing in a housing: defaults, and checks between keys.

use crate::ch2_housing::bore_contact::Penalty;
use crate::ch4_rotor::bore_friction::BoreFriction;
use crate::equilibrium::statics::COORDINATE_NAMES;
use crate::members::body::{Drive, DrivenBody, Rotation};
use crate::motion::simulation::Start;
use crate::numeric::profile::Profile;
use crate::plan::channels::ChannelGroup;
use crate::scene::build::assembly::PlacedHousing;
use crate::scene::error::{Problem, SceneError, um};
use crate::scene::resolve::bearing::{Reader, resolve_bearing, text};
use crate::scene::resolve::dynamics::drive_key;
use crate::scene::resolve::housing_scene::{FitSize, HousingMethod, HousingSettings};
use crate::scene::resolve::resolved::{Plot, RunPlot, Scene};
use crate::scene::resolve::solid::housing_solid;
use crate::scene::resolve::unused::refuse_unused;
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
    let method = reader.choice("housing.method");
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
    refuse_unused(document, &["housing"])?;
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

fn refused<T>(document: &Document, key: &str, reason: &str) -> Result<T, SceneError> {
    Err(document.refused(key, reason))
}

/// Friction of the bore; `None` without any, or with a coefficient of zero.
fn friction(
    reader: &mut Reader,
    method: HousingMethod,
) -> Result<Option<BoreFriction>, SceneError> {
    let [law, coefficient, stretch] =
        ["law", "coefficient", "stretch"].map(|key| format!("housing.friction.{key}"));
    if reader.choice_if_given(&law) != Some("stick-slip") {
        return Ok(None);
    }
    if method != HousingMethod::Explicit {
        let reason = "the springs of friction have a history, which needs the steps of `explicit`. Hint: leave `friction` out, or write method = \"explicit\"";
        return refused(reader.document, &law, reason);
    }
    let coefficient = reader.number(&coefficient);
    let stretch = reader.number(&stretch);
    Ok((coefficient != 0.0).then_some(BoreFriction { coefficient, stretch }))
}

/// The race must be free to move without another support; a rotating one needs friction.
fn refuse_motion(document: &Document, reader: &Reader, rough: bool) -> Result<(), SceneError> {
    let key = "outer_race.motion";
    match reader.choice_if_given(key) {
        Some("5-dof") => {}
        Some("6-dof") if rough => {}
        Some("6-dof") => {
            let reason = "the bore has no friction, so nothing would keep the race from turning. Hint: write motion = \"5-dof\", or friction.law = \"stick-slip\" in [housing]";
            return refused(document, key, reason);
        }
        _ => {
            let [race, housing] =
                ["outer_race", "housing"].map(|table| document.shown(table, true));
            let reason = format!(
                "a fixed outer race does not move in its housing. Hint: write motion = \"5-dof\" in [{race}], or method = \
                 \"rigid\" in [{housing}]"
            );
            return Err(document.error_here(key, Problem::refused(reason)));
        }
    }
    let reason = "the outer race is on a foundation or in a housing, not both. Hint: leave out [housing], or the foundation";
    document.refuse_given(&[("outer_race.foundation", reason)])
}

/// Refuses loads and motions of an outer race that a rigid housing fixes.
fn refuse_drives(document: &Document, bearing: &Scene) -> Result<(), SceneError> {
    const FIXED: &str =
        "a rigid housing fixes the outer race. Hint: leave it out, or choose another method";
    let Some(outer) = &bearing.dynamics.outer else { return Ok(()) };
    if matches!(&outer.rotation, Rotation::Speed(speed) if !speed.is_zero()) {
        return refused(document, "outer_race.speed", FIXED);
    }
    for (name, drive) in COORDINATE_NAMES.iter().zip(&outer.drives) {
        let moves =
            matches!(drive, Drive::Motion(profile) if !matches!(profile, Profile::Constant(_)));
        if moves {
            return refused(document, &drive_key("outer_race", name, false), FIXED);
        }
    }
    Ok(())
}

/// Start of explicit steps in equilibrium or not.
fn start(reader: &mut Reader, method: HousingMethod) -> Result<bool, SceneError> {
    let from_equilibrium =
        method == HousingMethod::Explicit && reader.choice("housing.start") == "equilibrium";
    if from_equilibrium && reader.is_given("housing.fit_ramp") {
        let reason = "a start in equilibrium includes the fit";
        return refused(reader.document, "housing.fit_ramp", reason);
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
        let shown = format!("{} s", plain(ramp));
        Some(reader.number_or("housing.fit_ramp", ramp, &shown, reason))
    });
    let width = reader.given_number("housing.width").or_else(|| {
        let length = bearing.dimensions.length;
        let (value, reason) = match length {
            Some(length) => (format!("{} mm", plain(1e3 * length)), "the bearing's length"),
            None => ("that of the bore".to_string(), "without it and `bearing.length`"),
        };
        let used = reader.note("housing.width", &value, reason);
        length.inspect(|length| {
            used.fill("housing.width", *length);
        })
    });
    let (unless_given, reason) = match friction {
        Some(_) => ("free", "friction supports the race along its axis"),
        None => ("fixed", "a shoulder or ring beside the bore; the bore has no friction"),
    };
    let axial = reader.choice_or("housing.axial", unless_given, reason);
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
    if method == HousingMethod::Explicit {
        step_fraction = reader.number("housing.step_fraction");
        coupling_phase = reader.number("housing.coupling_phase");
    }
    let [modes_to, bore_load] =
        ["housing.modes_to", "housing.bore_load"].map(|key| reader.given_number(key));
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
            let problem = Problem::Contradiction(format!(
                "the fit of {} is more than a hundredth of the outer race's radius. Allowed: {} to {}. Hint: check its unit",
                um(fit),
                um(-limit),
                um(limit)
            ));
            Err(document.error(key, problem))
        }
        (None, Some(radius)) => {
            if radius > groove {
                return Ok(FitSize::OuterRadius(radius));
            }
            let other = ("the outer race's groove bottom", groove);
            let problem =
                Problem::order(radius, "more than", other, "it is the outside of the race");
            Err(document.error("housing.outer_radius", problem))
        }
        (None, None) => {
            let key = "housing.fit.radial";
            reader.note("housing.fit", "{ radial = 0 um }", "a transition fit").fill(key, 0.0);
            Ok(FitSize::Interference(0.0))
        }
    }
}

/// Refuses prescribed motions across the axis and moments of an outer race, which its housing cannot take.
fn refuse_drives_in_housing(
    document: &Document,
    outer: &DrivenBody,
    hint: &str,
    takes: impl Fn(&Profile) -> bool,
) -> Result<(), SceneError> {
    for (i, (name, drive)) in COORDINATE_NAMES.iter().zip(&outer.drives).enumerate() {
        let reason = match drive {
            Drive::Motion(_) if i > 0 => {
                "in equilibrium the housing determines the position of the outer race"
            }
            Drive::Load(load) if i > 2 && !load.is_zero() && !takes(load) => {
                "in equilibrium the outer race takes forces, not moments"
            }
            _ => continue,
        };
        let key = drive_key("outer_race", name, matches!(drive, Drive::Load(_)));
        return refused(document, &key, &format!("{reason}. Hint: {hint}"));
    }
    Ok(())
}

/// Refuses loads that need inertia in a quasi-static sequence.
fn refuse_inertia(document: &Document, bearing: &Scene) -> Result<(), SceneError> {
    const HINT: &str = "leave it out, or write method = \"explicit\" in [housing]";
    let Some(outer) = &bearing.dynamics.outer else { return Ok(()) };
    refuse_drives_in_housing(document, outer, HINT, |_| false)?;
    for (name, drive) in COORDINATE_NAMES.iter().zip(&outer.drives) {
        if matches!(drive, Drive::Load(load) if !matches!(load, Profile::Constant(_))) {
            let reason = format!("a quasi-static outer race takes constant loads. Hint: {HINT}");
            return refused(document, &drive_key("outer_race", name, true), &reason);
        }
    }
    let because = |reason: &str| format!("{reason}. Hint: {HINT}");
    let [ideal, equal, needs_inertia] = [
        because("an equilibrium has ideal races and balls only"),
        because("an equilibrium has equal balls only"),
        because("an unbalance needs inertia"),
    ];
    let unbalance = [("inner_race.unbalance", &needs_inertia[..])];
    document.refuse_given(&unbalance[..usize::from(bearing.dynamics.unbalance != 0.0)])?;
    document.refuse_given(&[
        (
            "inner_race.torque",
            "without inertia no speed follows from a torque. Hint: give inner_race.speed",
        ),
        ("bearing.dent", &ideal),
        ("bearing.spall", &ideal),
        ("bearing.waviness", &ideal),
        ("bearing.ball.deviations", &equal),
        ("bearing.ball.scatter", &equal),
    ])
}

/// Refuses what the equilibrium at the start of a reduced housing cannot have.
fn refuse_start(document: &Document, bearing: &Scene) -> Result<(), SceneError> {
    const HINT: &str = "leave it out, or write start = \"nominal\" in [numerics]";
    match (&bearing.dynamics.outer, &bearing.dynamics.run) {
        (Some(outer), Some(run)) if run.options.start != Start::Nominal => {
            refuse_drives_in_housing(document, outer, HINT, |load| load.value(0.0) == 0.0)
        }
        _ => Ok(()),
    }
}

/// Fixes the axial position of a race with an axial support, and drops the defaults of a free one.
fn rest(
    document: &Document,
    bearing: &mut Scene,
    housing: &HousingSettings,
) -> Result<(), SceneError> {
    let nominal =
        bearing.dynamics.run.as_ref().is_some_and(|run| run.options.start == Start::Nominal);
    if nominal && housing.method == HousingMethod::Explicit {
        let reason = "in a housing inner race and balls start in equilibrium with the outer race in its nominal position";
        return refused(document, "numerics.start", reason);
    }
    let start = bearing.outer_race[0];
    let Some(DrivenBody { drives, .. }) = &mut bearing.dynamics.outer else { return Ok(()) };
    let mut said = vec!["outer_race.foundation"];
    if housing.axial == Axial::Fixed
        && let Drive::Load(load) = &drives[0]
    {
        if !load.is_zero() && housing.method != HousingMethod::QuasiStatic {
            let reason = "a support beside the bore fixes the race along its axis. Hint: leave it out, or write axial = \"free\" in [housing]";
            return refused(document, "outer_race.x.load", reason);
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
                      `series` and `spectrum`. Hint: leave the others out, or write method = \"explicit\" in [housing] for `polar`, \
                      `slip-spin` and `run-up`";
        return refused(document, "output.plots", reason);
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
        let reason = "equilibria have `races`, `loads`, `forces` and `energy`. Hint: leave the others out, or write method = \"explicit\" in [housing]";
        return refused(document, "output.channels", reason);
    }
    if run.channels.contains(&Loads) {
        channels.push(Loads);
    }
    channels.sort();
    run.channels = channels;
    Ok(())
}
