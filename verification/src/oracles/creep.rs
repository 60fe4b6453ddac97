//! A mass on a bushing under a load, by its Laplace transform: no Prony series, no step in time.

use nalgebra::Complex;
use std::f64::consts::PI;

type C = Complex<f64>;

/// The function of time whose transform is `f`, at `t` > 0, by Talbot's contour with `terms` points (Abate and Valkó, Int. J. Numer.
/// Meth. Engng 60, 2004): to about 0.6 digits a point until rounding, e^(2 terms/5) of it, takes over. Poles
/// that swing faster than some terms/t are left out.
pub fn inverse(f: impl Fn(C) -> C, t: f64, terms: usize) -> f64 {
    let count = terms as f64;
    let reach = 0.4 * count / t;
    let first = f(C::new(reach, 0.0)).re * 0.5 * (reach * t).exp();
    let rest = (1..terms).map(|k| {
        let angle = PI * k as f64 / count;
        let cot = 1.0 / angle.tan();
        let s = C::new(angle * cot, angle) * reach;
        let turn = C::new(1.0, angle + (angle * cot - 1.0) * cot);
        ((s * t).exp() * f(s) * turn).re
    });
    reach / count * (first + rest.sum::<f64>())
}

/// A mass (kg) on what resists it by `stiffness(s)`, N/m.
pub struct OnBushing<K: Fn(C) -> C> {
    pub mass: f64,
    pub stiffness: K,
}

impl<K: Fn(C) -> C> OnBushing<K> {
    /// Displacement at `t` s after a force began to grow to `load` N, evenly within `duration` s.
    pub fn after_ramp(&self, load: f64, duration: f64, t: f64, terms: usize) -> f64 {
        let to_slope = |s: C| ((self.stiffness)(s) + s * s * self.mass).inv() / (s * s);
        let since = |t: f64| if t > 0.0 { inverse(to_slope, t, terms) } else { 0.0 };
        load / duration * (since(t) - since(t - duration))
    }
}
