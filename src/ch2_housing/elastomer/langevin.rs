//! The Langevin function of a chain's pull, its inverse, and the five-term series of the inverse.

/// L(β) = coth β − 1/β and its derivative, for β ≥ 0.
fn langevin(beta: f64) -> [f64; 2] {
    // Below, coth β and 1/β cancel; the next term of the series is 1e-16 of the first.
    if beta < 0.1 {
        let s = beta * beta;
        let value = beta
            * (1.0 / 3.0
                - s * (1.0 / 45.0 - s * (2.0 / 945.0 - s * (1.0 / 4725.0 - s * 2.0 / 93555.0))));
        let slope = 1.0 / 3.0
            - s * (1.0 / 15.0 - s * (2.0 / 189.0 - s * (1.0 / 675.0 - s * 2.0 / 10395.0)));
        return [value, slope];
    }
    let per = 1.0 / beta;
    // 1/sinh² as 4 e⁻²ᵝ/(1 − e⁻²ᵝ)², which does not overflow.
    let fade = libm::exp(-2.0 * beta);
    let rest = -libm::expm1(-2.0 * beta);
    [(1.0 + fade) / rest - per, per * per - 4.0 * fade / (rest * rest)]
}

/// β = L⁻¹(x) and dβ/dx for 0 < x < 1, by Newton's method from Cohen's approximation (1991).
pub fn inverse(x: f64) -> [f64; 2] {
    let mut beta = x * (3.0 - x * x) / (1.0 - x * x);
    // The start is good to 5 %, so that four steps would do.
    for _ in 0..8 {
        let [value, slope] = langevin(beta);
        let step = (x - value) / slope;
        beta += step;
        if step.abs() <= 4.0 * f64::EPSILON * beta {
            break;
        }
    }
    [beta, 1.0 / langevin(beta)[1]]
}

/// ln(β/sinh β).
pub fn log_of_ratio(beta: f64) -> f64 {
    // sinh β = eᵝ(1 − e⁻²ᵝ)/2.
    libm::log(2.0 * beta / -libm::expm1(-2.0 * beta)) - beta
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_inverse_undoes_the_function() {
        for x in [1e-6, 1e-3, 0.03, 0.0333, 0.1, 0.3536, 0.7, 0.95, 0.999, 0.999_999] {
            let [beta, slope] = inverse(x);
            // Rounding of coth β − 1/β, both up to 10.
            assert!((langevin(beta)[0] - x).abs() <= 4e-15, "{x}");
            let h = 1e-5 * x.min(1.0 - x);
            let difference = (inverse(x + h)[0] - inverse(x - h)[0]) / (2.0 * h);
            // The third derivative, 1e-10, and rounding of x: 1e-16/(1 − x) of β over a difference of 1e-5.
            assert!(
                (difference / slope - 1.0).abs() <= 1e-9 + 1e-11 / (1.0 - x),
                "{x}: {difference} {slope}"
            );
        }
    }

    #[test]
    fn both_forms_meet_where_they_change() {
        let [below, above] = [0.1 - 1e-12, 0.1 + 1e-12].map(langevin);
        // The change over the gap, 2e-12/3, and cancellation in coth β − 1/β, 1e-16·10/0.03.
        assert!((above[0] - below[0] - 2e-12 / 3.0).abs() <= 4e-15);
        assert!((above[1] / below[1] - 1.0).abs() <= 1e-12);
    }
}
