//! Where bearings may sit on bodies.

use bearing_dynamics::scene::{Document, Format, resolve_subject};

const BEARINGS: &str = r#"
defaults = "dissertation"
[bearing]
kind = "deep-groove"
balls = 8
clearance = { radial = "0 um" }
ball = { radius = "6 mm" }
inner_race = { radius = "20 mm", groove_radius = "6.25 mm" }
outer_race = { groove_radius = "6.3 mm" }
[body.shaft]
[body.frame]
"#;

/// What is wrong with a scene, if anything is.
fn fault(text: &str) -> Option<String> {
    let text = format!("{BEARINGS}{text}");
    let document = Document::read_str(&text, Format::Toml, "scene.toml").unwrap();
    resolve_subject(&document).err().map(|error| error.to_string())
}

/// A ball's radius and what the grooves leave, 6 mm and 0.55 mm.
#[test]
fn races_of_a_bearing_stand_about_each_other() {
    let one = |places: &str, shaft: &str| {
        fault(&format!(
            "{shaft}\n[bearing.a]\ninner_on = \"shaft\"\nouter_on = \"frame\"\n{places}\n"
        ))
    };
    let far = one("inner_at = \"-100 mm\"\nouter_at = \"0 mm\"", "").unwrap();
    let words = "bearing.a.outer_at: refused: its inner race is at -100.0000 mm along the axis and its outer one at 0.0000 mm";
    assert!(far.contains(words) && far.contains("within 6.5500 mm"), "{far}");
    assert_eq!(one("inner_at = \"-100 mm\"", ""), None);
    for (outer_at, fits) in [("6.5 mm", true), ("-6.5 mm", true), ("6.6 mm", false)] {
        let found = one(&format!("inner_at = \"0 mm\"\nouter_at = \"{outer_at}\""), "");
        assert_eq!(found.is_none(), fits, "{outer_at}: {found:?}");
    }
    // A body that is held elsewhere takes its race along.
    let held = "[body.shaft.x]\ndisplacement = \"5 mm\"";
    assert_eq!(one("inner_at = \"-5 mm\"\nouter_at = \"6 mm\"", held), None);
    assert!(one("inner_at = \"-5 mm\"\nouter_at = \"7 mm\"", held).is_some());
    let own =
        fault("[bearing.a]\ninner_on = \"shaft\"\ninner_at = \"9 mm\"\nouter_at = \"0 mm\"\n")
            .unwrap();
    assert!(own.contains("which is 9.0000 mm apart"), "{own}");
}
