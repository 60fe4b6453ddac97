//! Langevin function of a chain, its inverse, and the logarithm in its energy.

/// L(β) = coth β − 1/β and its derivative, for β ≥ 0.
pub fn langevin(beta: f64) -> [f64; 2] {
    // For small β, coth β and 1/β cancel; the next term of the series is 1e-16 of the first.
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
    let decay = libm::exp(-2.0 * beta);
    let rest = -libm::expm1(-2.0 * beta);
    [(1.0 + decay) / rest - per, per * per - 4.0 * decay / (rest * rest)]
}

/// β = L⁻¹(x) and dβ/dx for 0 < x < 1, by Newton's method from Cohen's approximation (1991).
pub fn inverse(x: f64) -> [f64; 2] {
    let mut beta = x * (3.0 - x * x) / (1.0 - x * x);
    // The initial guess has an error of 5 %; four iterations suffice.
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
