//! What is printed, as the file of a case states it.

use verification::published::{Published, PublishedError};

const ENTRY: &str = r#"
[[value]]
id = "moment"
quantity = "moment at 0.15° tilt"
value = 6.423
unit = "N·m"
source = "3.4.5"
rounding = 0.001
"#;

#[test]
fn reads_an_entry_and_keeps_its_unit() {
    let published = Published::parse(ENTRY).unwrap();
    let entry = published.get("moment").unwrap();
    assert_eq!((entry.value, entry.unit.as_str()), (6.423, "N·m"));
    assert_eq!(published.with("moment", 7.0).get("moment").unwrap().value, 7.0);
}

#[test]
fn a_file_without_entries_is_allowed() {
    assert!(Published::parse("# nothing is printed\n").unwrap().values().is_empty());
}

#[test]
fn each_defect_has_its_own_error() {
    let with = |from: &str, to: &str| Published::parse(&ENTRY.replace(from, to));
    assert!(matches!(with("\"N·m\"", "\" \""), Err(PublishedError::Empty { field: "unit", .. })));
    assert!(matches!(with("6.423", "nan"), Err(PublishedError::NotFinite { .. })));
    assert!(matches!(with("0.001", "-1.0"), Err(PublishedError::Rounding { .. })));
    assert!(matches!(with("source", "sauce"), Err(PublishedError::Syntax(_))));
    assert_eq!(
        Published::parse(&[ENTRY, ENTRY].concat()),
        Err(PublishedError::DuplicateId("moment".into()))
    );
}
