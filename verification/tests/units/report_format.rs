//! How the report writes numbers.

use verification::report::format::{fraction, limit_fraction, limit_text, significant, six_digits};

#[test]
fn significant_digits() {
    let cases = [
        (6.42134, 5, "6.4213"),
        (-0.00123456, 4, "−0.001235"),
        (56_951_234_567.0, 5, "5.6951e10"),
        (3.2e-13, 3, "3.2e−13"),
        (99_999.96, 6, "100000"),
        (0.0, 4, "0"),
        (1234.5678, 5, "1234.6"),
    ];
    for (value, digits, text) in cases {
        assert_eq!(significant(value, digits), text);
    }
    assert_eq!(six_digits(Some(8.0), "1"), "8");
    assert_eq!(six_digits(Some(8.0), "N"), "8.00000");
    assert_eq!(six_digits(Some(f64::NAN), "1"), "NaN");
    assert_eq!(limit_fraction(0.05), "5 %");
    assert_eq!(limit_fraction(0.001), "0.1 %");
    assert_eq!(limit_text(1e-13), "1e−13");
    assert_eq!(limit_text(200.0), "200");
    assert_eq!(fraction(0.0034), "0.340 %");
    assert_eq!(fraction(2.1e-14), "2.1e−14");
}
