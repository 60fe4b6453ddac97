//! Plots are well-formed, show what they are given, and refuse what cannot be drawn.

#[allow(dead_code)]
use crate::output_common;

use bearing_dynamics::ch2_housing::bearing::geometry::{BearingGeometry, BearingKind, Raceway};
use bearing_dynamics::output::pictures::bearing::{Picture, draw};
use bearing_dynamics::output::plots::load_zone::LoadZoneBall;
use bearing_dynamics::output::plots::{
    Axis, Curve, LoadZone, Mark, PlotError, PolarPlot, Style, XyPlot, load_zone, polar, xy,
    xy_marked,
};
use bearing_dynamics::output::series::{Column, Series};
use bearing_dynamics::output::table::RunTable;
use ndarray::Array2;
use output_common::solution;
use std::path::Path;

fn xy_plot(curves: Vec<Curve>) -> XyPlot {
    XyPlot {
        title: "Moment over tilt".into(),
        x: Axis::linear("tilt", "deg"),
        y: Axis::linear("moment", "N m"),
        style: Style::LinesAndMarkers,
        curves,
    }
}

fn zone() -> LoadZone {
    let balls = solution().balls.into_iter().map(|ball| LoadZoneBall {
        azimuth: ball.azimuth,
        loaded: ball.inner.normal_load > 0.0,
        outer_load: ball.outer.normal_load,
    });
    LoadZone {
        title: "Load zone under 1500 N, radial clearance 5 µm".into(),
        inner_raceway_radius: 0.020047,
        outer_raceway_radius: 0.031953,
        pitch_radius: 0.026,
        ball_radius: 0.005953,
        balls: balls.collect(),
    }
}

fn polar_plot(curves: Vec<Curve>) -> PolarPlot {
    PolarPlot {
        title:
            "Normal load of each ball on the outer race under a radial load of 1500 N, tilt given"
                .into(),
        quantity: "force".into(),
        unit: "N".into(),
        curves,
    }
}

fn ball_curve(name: &str, factor: f64) -> Curve {
    let point = |ball: &bearing_dynamics::equilibrium::statics::BallState| {
        [ball.azimuth, factor * ball.outer.normal_load]
    };
    Curve::new(name, solution().balls.iter().map(point).collect())
}

#[test]
fn separate_values_are_marked_and_not_joined() {
    let line = Curve::new("computed", vec![[0.0, 0.0], [0.1, 3.2]]);
    let values = vec![[0.02, 0.5], [0.05, 1.4], [0.09, 2.9]];
    let lines = |curves| xy(&xy_plot(curves)).unwrap().matches("<polyline").count();
    let alone = lines(vec![line.clone()]);
    assert_eq!(lines(vec![line.clone(), Curve::separate("printed", values.clone())]), alone);
    // Joined, the curve and its sample in the legend are one more line each.
    assert_eq!(lines(vec![line, Curve::new("printed", values)]), alone + 2);
    // In a plot of lines alone they still are marked.
    let mut plot = xy_plot(vec![Curve::separate("printed", vec![[0.0, 1.0], [0.1, 2.0]])]);
    plot.style = Style::Lines;
    assert_eq!(xy(&plot).unwrap().matches("<circle").count(), 3);
}

/// Set BEARING_PLOTS=FOLDER to look at the pictures.
fn keep(name: &str, svg: &str) {
    if let Some(folder) = std::env::var_os("BEARING_PLOTS") {
        std::fs::write(Path::new(&folder).join(name), svg).unwrap();
    }
}

fn assert_svg(svg: &str, texts: &[&str]) {
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
    assert!(!svg.contains("NaN") && !svg.contains("inf\""));
    let lines: Vec<&str> = svg.lines().map(str::trim).collect();
    for text in texts {
        assert!(lines.contains(text), "{text:?} is not in the plot");
    }
}

/// Everything in the markup is a character that XML can hold, whatever a scene is called.
#[test]
fn names_that_xml_cannot_hold_leave_it_well_formed() {
    let hostile = "a\u{fffe}b\u{ffff}c\u{1b}[31md\u{0}e\u{b}\u{9b}\u{7f}";
    let curve = || Curve::new(hostile, vec![[0.0, 0.0], [0.1, 1.0]]);
    let mut xy_form = xy_plot(vec![curve()]);
    xy_form.title = hostile.into();
    xy_form.y = Axis::linear(hostile, hostile);
    let mut zone = zone();
    zone.title = hostile.into();
    let mut polar_form = polar_plot(vec![ball_curve(hostile, 1.0)]);
    polar_form.title = hostile.into();
    for svg in [xy(&xy_form).unwrap(), load_zone(&zone).unwrap(), polar(&polar_form).unwrap()] {
        let allowed = |c: char| matches!(c, '\t' | '\n' | '\r' | '\u{20}'..='\u{fffd}' | '\u{10000}'..='\u{10ffff}');
        assert!(svg.chars().all(allowed) && svg.contains("abc[31mde"), "{svg}");
    }
}

#[test]
fn xy_names_curves_and_units() {
    let curve = |name: &str, power: f64| {
        let points = (0..=20).map(|i| f64::from(i) * 0.01);
        Curve::new(name, points.map(|x| [x, 60.0 * x.powf(power)]).collect())
    };
    let names = [
        "hamrock-brewe",
        "exact integrals",
        "published, Table 3.7",
        "clearance 5 µm",
        "a & b < c",
        "six",
    ];
    let curves = names.iter().enumerate().map(|(i, n)| curve(n, 1.0 + 0.2 * i as f64)).collect();
    let svg = xy(&xy_plot(curves)).unwrap();
    keep("xy.svg", &svg);
    assert_svg(
        &svg,
        &["tilt [deg]", "moment [N m]", "0.20", "exact integrals", "a &amp; b &lt; c"],
    );
}

#[test]
fn logarithmic_axes_and_single_points() {
    let points = (0..8).map(|i| [10f64.powi(i - 6), 10f64.powi(-2 * i)]).collect();
    let mut plot = xy_plot(vec![Curve::new("error", points), Curve::new("one", vec![[0.1, 1e-8]])]);
    plot.x = Axis::log("run time", "s");
    plot.y = Axis::log("relative error", "1");
    plot.title = "Run time against error".into();
    let svg = xy(&plot).unwrap();
    keep("log.svg", &svg);
    assert_svg(&svg, &["run time [s]", "relative error [1]", "0.1", "1e-14"]);
    plot.style = Style::Markers;
    assert_svg(&xy(&plot).unwrap(), &["one"]);
    for value in [0.0, -1.0] {
        plot.curves[1].points[0][1] = value;
        assert!(matches!(xy(&plot), Err(PlotError::NotPositive { point: 0, .. })));
    }
    let flat = xy(&xy_plot(vec![Curve::new("flat", vec![[1.0, 2.0]])])).unwrap();
    keep("flat.svg", &flat);
    assert_svg(&flat, &["flat"]);
}

#[test]
fn a_point_is_drawn_where_the_axes_say() {
    // Both axes run from 0 to 10; the middle of the frame is ((115 + 870) / 2, (60 + 500) / 2).
    let points = vec![[0.0, 0.0], [5.0, 5.0], [10.0, 10.0]];
    let svg = xy(&xy_plot(vec![Curve::new("line", points)])).unwrap();
    assert!(svg.contains("<circle cx=\"493\" cy=\"280\""), "{svg}");
}

#[test]
fn polar_curves_over_azimuth() {
    let curves = vec![ball_curve("clearance 5 µm", 1.0), ball_curve("clearance 0 µm", 0.8)];
    let svg = polar(&polar_plot(curves)).unwrap();
    keep("polar.svg", &svg);
    assert_svg(
        &svg,
        &["90° (+Z)", "0° (+Y)", "radius: force [N]; angle: azimuth [deg]", "clearance 5 µm"],
    );
    let both = polar(&PolarPlot::ball_loads("Loads", &solution())).unwrap();
    assert_svg(&both, &["radius: normal load [N]; angle: azimuth [deg]", "on the inner race"]);
    let negative = polar(&polar_plot(vec![Curve::new("a", vec![[0.0, 1.0], [1.0, -1e-9]])]));
    assert!(matches!(negative, Err(PlotError::Negative { point: 1, .. })));
    assert_svg(&polar(&polar_plot(vec![ball_curve("none", 0.0)])).unwrap(), &["none"]);
}

/// Where the first circle with `fill` in it is drawn.
fn circle(svg: &str, fill: &str) -> [f64; 2] {
    let mut circles = svg.split("<circle ").skip(1).map(|rest| rest.split("/>").next().unwrap());
    let circle = circles.find(|circle| circle.contains(fill)).unwrap();
    ["cx=\"", "cy=\""].map(|name| {
        let (_, value) = circle.split_once(name).unwrap();
        value.split('"').next().unwrap().parse().unwrap()
    })
}

/// Pieces of a curve over azimuth are joined up to three times the usual distance of its points.
#[test]
fn polar_curves_are_interrupted_at_azimuths_without_points() {
    let at = |degrees: usize| [(2.0 * degrees as f64).to_radians(), 10.0];
    let lines = |points: Vec<usize>| {
        let curve = Curve::new("a", points.into_iter().map(at).collect());
        polar(&polar_plot(vec![curve])).unwrap().matches("<polyline").count()
    };
    let whole = lines((0..180).collect());
    assert_eq!(lines((0..180).filter(|i| i % 60 != 1).collect()), whole);
    assert_eq!(lines((0..180).filter(|i| i % 60 < 30).collect()), whole + 2);
    assert_eq!(lines((0..180).filter(|i| (5..15).contains(&(i % 60))).collect()), whole + 2);
    // A point alone is a marker.
    let alone = lines((0..100).chain([140]).collect());
    assert_eq!(alone, whole);
}

/// Seen against the axial direction: Y to the right, Z up.
#[test]
fn azimuths_go_from_y_to_z_as_they_are_seen() {
    for degrees in [0.0f64, 60.0, 90.0, 200.0, 300.0] {
        let (azimuth, mut zone) = (degrees.to_radians(), zone());
        zone.balls = vec![LoadZoneBall { azimuth, loaded: true, outer_load: 100.0 }];
        let curve = Curve::separate("a ball", vec![[azimuth, 100.0]]);
        let polar = polar(&polar_plot(vec![curve])).unwrap();
        let ball = circle(&load_zone(&zone).unwrap(), "fill=\"#D53C28\"");
        for (at, middle) in [(ball, [450.0, 400.0]), (circle(&polar, "fill"), [450.0, 375.0])] {
            let (y, z) = (at[0] - middle[0], middle[1] - at[1]);
            let radius = y.hypot(z);
            assert!(radius > 100.0, "{degrees}: {at:?}");
            // Whole pixels.
            assert!((y - radius * azimuth.cos()).abs() <= 1.0, "{degrees}: {at:?}");
            assert!((z - radius * azimuth.sin()).abs() <= 1.0, "{degrees}: {at:?}");
        }
    }
}

#[test]
fn load_zone_draws_each_ball_and_states_the_scale() {
    let zone = zone();
    let svg = load_zone(&zone).unwrap();
    keep("load_zone.svg", &svg);
    assert_svg(&svg, &["Y", "Z", "in contact with the inner race", "open", "1", "8"]);
    assert!(svg.contains("N; at the balls: load on the outer race [N]"));
    let red = "fill=\"#D53C28\"";
    let loaded = zone.balls.iter().filter(|ball| ball.loaded).count();
    assert_eq!(svg.matches(red).count(), loaded + 1, "every loaded ball and the key");

    let mut unloaded = zone.clone();
    for ball in &mut unloaded.balls {
        (ball.loaded, ball.outer_load) = (false, 0.0);
    }
    let svg = load_zone(&unloaded).unwrap();
    assert_svg(&svg, &["no ball is loaded"]);
    assert_eq!(svg.matches(red).count(), 1);
    let mut many = zone;
    many.title = "Preloaded bearing".into();
    many.ball_radius = 0.0025;
    many.balls = (0..30)
        .map(|i| LoadZoneBall { azimuth: f64::from(i) * 0.2094, loaded: true, outer_load: 4e4 })
        .collect();
    keep("load_zone_many.svg", &load_zone(&many).unwrap());
}

#[test]
fn a_load_zone_takes_its_sizes_from_the_geometry() {
    // Races of Table 3.5: radii of the groove bottoms and of the grooves in m.
    let (inner, outer, ball) = (0.020047, 0.031953, 0.005953);
    let (inner_groove, outer_groove) = (0.006013, 0.006310);
    let raceway =
        |centre_radius, groove_radius| Raceway { centre_radius, centre_axial: 0.0, groove_radius };
    let geometry = BearingGeometry {
        kind: BearingKind::DeepGroove,
        ball_count: 8,
        ball_radius: ball,
        inner: raceway(inner + inner_groove, inner_groove),
        outer: raceway(outer - outer_groove, outer_groove),
        pitch_radius: 0.026,
        contact_angle: 0.0,
        radial_clearance: 0.0,
    };
    let drawn = LoadZone::new(zone().title, &geometry, &solution().balls);
    assert!((drawn.inner_raceway_radius - inner).abs() <= 1e-15);
    assert!((drawn.outer_raceway_radius - outer).abs() <= 1e-15);
    assert_eq!(drawn.balls, zone().balls);
    assert_eq!(load_zone(&drawn).unwrap(), load_zone(&zone()).unwrap());
    // One that its weight or speed presses on the outer race alone carries nothing between the races.
    let mut flung = solution().balls;
    let idle = flung.iter().position(|ball| ball.inner.normal_load == 0.0).unwrap();
    flung[idle].outer.normal_load = 3.5;
    let drawn = &LoadZone::new(zone().title, &geometry, &flung).balls[idle];
    assert!(!drawn.loaded && drawn.outer_load == 3.5, "{drawn:?}");
}

#[test]
fn input_that_cannot_be_drawn_is_refused() {
    assert!(matches!(xy(&xy_plot(vec![])), Err(PlotError::NoCurve { .. })));
    let empty = || vec![Curve::new("empty", vec![])];
    assert!(matches!(xy(&xy_plot(empty())), Err(PlotError::NoPoint { .. })));
    assert!(matches!(polar(&polar_plot(empty())), Err(PlotError::NoPoint { .. })));
    for bad in [f64::NAN, f64::INFINITY, -1e201, 1e-310] {
        for point in [[bad, 1.0], [1.0, bad]] {
            let curves = || vec![Curve::new("bad", vec![[0.0, 0.0], point])];
            assert!(matches!(xy(&xy_plot(curves())), Err(PlotError::NotDrawable { point: 1, .. })));
            let result = polar(&polar_plot(curves()));
            assert!(matches!(result, Err(PlotError::NotDrawable { point: 1, .. })));
        }
    }
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut wrong = zone();
        wrong.ball_radius = bad;
        assert!(matches!(load_zone(&wrong), Err(PlotError::Size { .. })));
        let mut wrong = zone();
        wrong.balls[3].azimuth = bad;
        assert!(matches!(load_zone(&wrong), Err(PlotError::Ball { ball: 4, .. })));
        let mut wrong = zone();
        wrong.balls[3].outer_load = bad;
        assert!(matches!(load_zone(&wrong), Err(PlotError::Ball { ball: 4, .. })));
    }
    let mut wrong = zone();
    wrong.balls.clear();
    assert!(matches!(load_zone(&wrong), Err(PlotError::NoBall)));
}

/// A ball that stays at one azimuth is drawn there in the plot of loads over azimuth: in the middle of a sector.
#[test]
fn loads_over_azimuth_are_drawn_where_the_ball_is() {
    let columns = [("time", "s"), ("ball_1_angle", "deg"), ("ball_1_outer_load", "N")];
    let columns = columns.map(|(name, unit)| Column::new(name, unit)).to_vec();
    let rows = [[0.0, 91.5, 100.0], [0.1, 91.5 - 360.0, 300.0], [0.2, 91.5 + 720.0, 200.0]];
    let table = RunTable {
        series: Series::new(columns, Array2::from(rows.to_vec())).unwrap(),
        interval: 0.1,
        window: 0..3,
        bearings: vec![String::new()],
        bodies: Vec::new(),
        sensors: Vec::new(),
        geometries: Vec::new(),
    };
    let drawn = draw(Picture::Polar, "A ball", &table).unwrap();
    let [(file, found)] = &drawn[..] else { panic!("{drawn:?}") };
    let there = Curve::new("ball on outer race", vec![[91.5f64.to_radians(), 200.0]]);
    let expected = PolarPlot {
        title: "A ball: normal load over ball azimuth".into(),
        quantity: "mean normal load over 3 deg".into(),
        ..polar_plot(vec![there])
    };
    assert_eq!((file.as_str(), found), ("polar.svg", &polar(&expected).unwrap()));
}

/// Ball 1 may be unloaded all the time.
#[test]
fn loads_over_time_are_those_of_the_most_loaded_ball() {
    let loads = ["ball_1_inner_load", "ball_2_inner_load", "ball_3_inner_load"];
    let mut columns = vec![Column::new("time", "s")];
    columns.extend(loads.map(|name| Column::new(name, "N")));
    let rows = [[0.0, 0.0, 5.0, 7.0], [0.1, 0.0, 9.0, 7.0]];
    let table = RunTable {
        series: Series::new(columns, Array2::from(rows.to_vec())).unwrap(),
        interval: 0.1,
        window: 0..2,
        bearings: vec![String::new()],
        bodies: Vec::new(),
        sensors: Vec::new(),
        geometries: Vec::new(),
    };
    let drawn = draw(Picture::Series, "Balls", &table).unwrap();
    let [(file, svg)] = &drawn[..] else { panic!("{drawn:?}") };
    assert_eq!(file, "series_loads.svg");
    assert!(svg.contains("ball 2 on inner race") && svg.contains("most loaded ball"), "{svg}");
}

/// Marks within the axis are lines with labels; a label that would cover an earlier one is left out.
#[test]
fn marks_are_labelled_lines_within_the_axis() {
    let plot = xy_plot(vec![Curve::new("computed", vec![[0.0, 0.0], [10.0, 3.0]])]);
    let mark = |at: f64, label: &str| Mark { at, label: label.into() };
    let (plain, marks) =
        (xy(&plot).unwrap(), [mark(4.0, "BPFO"), mark(4.01, "hidden"), mark(11.0, "beyond")]);
    let marked = xy_marked(&plot, &marks).unwrap();
    let lines = |svg: &str| svg.matches("#969696").count();
    assert_eq!((lines(&plain), lines(&marked)), (0, 2));
    for (label, shown) in [("BPFO", true), ("hidden", false), ("beyond", false)] {
        assert_eq!(marked.contains(label), shown, "{label}");
    }
    assert_eq!(xy_marked(&plot, &[]).unwrap(), plain);
}
