//! Rating life of a bearing in equilibrium: a line of the printed table and a section of the summary.

use bearing_dynamics::ch2_housing::bearing::rating::{
    LARGEST_CONTACT_ANGLE, dynamic_rating, reference_life,
};
use bearing_dynamics::equilibrium::statics::BallState;
use bearing_dynamics::output::results::{ResultsError, quantity};
use bearing_dynamics::scene::Scene;
use serde_json::{Value, json};
use std::f64::consts::{PI, TAU};

pub struct Life {
    /// Dynamic load rating, N.
    rating: f64,
    given: bool,
    /// L₁₀ᵣ, 10⁶ revolutions.
    million: f64,
    /// Of one race relative to the other, rad/s.
    speed: f64,
}

impl Life {
    /// `None` for a thrust bearing, and without a loaded ball.
    pub fn of(scene: &Scene, balls: &[BallState]) -> Option<Life> {
        let geometry = &scene.geometry;
        if geometry.contact_angle > LARGEST_CONTACT_ANGLE {
            return None;
        }
        let rating = scene.dynamic_rating.unwrap_or_else(|| dynamic_rating(geometry));
        let loads = balls.iter().map(|ball| [ball.inner.normal_load, ball.outer.normal_load]);
        let loads: Vec<_> = loads.collect();
        let [inner, outer] = [scene.inner_speed, scene.outer_speed].map(Option::unwrap_or_default);
        // Loads are fixed in space. Without a speed the inner race is the rotating one.
        let turns = [inner != 0.0 || outer == 0.0, outer != 0.0];
        let million = reference_life(geometry, rating, &loads, turns)?;
        let speed = (inner - outer).abs();
        Some(Life { rating, given: scene.dynamic_rating.is_some(), million, speed })
    }

    fn hours(&self) -> Option<f64> {
        (self.speed > 0.0).then(|| 1e6 * self.million * TAU / self.speed / 3600.0)
    }

    /// P of L = (C/P)³, N.
    fn equivalent_load(&self) -> f64 {
        self.rating / self.million.cbrt()
    }

    fn rating_is(&self) -> &'static str {
        if self.given { "given" } else { "ISO 281" }
    }

    pub fn text(&self) -> String {
        let hours = self.hours().map_or(String::new(), |hours| {
            format!(", {} h at {} rpm", short(hours), short(self.speed * 30.0 / PI))
        });
        format!(
            "rating life {} million revolutions{hours}; dynamic rating {} kN ({}), equivalent load {} kN\n",
            short(self.million),
            short(1e-3 * self.rating),
            self.rating_is(),
            short(1e-3 * self.equivalent_load())
        )
    }

    pub fn section(life: &Option<Life>) -> Result<Value, ResultsError> {
        let Some(life) = life else {
            return Ok(json!({ "left_out": "no load, or a thrust bearing" }));
        };
        let mut section = json!({
            "dynamic_rating": quantity("dynamic_rating", life.rating, "N")?,
            "dynamic_rating_is": life.rating_is(),
            "revolutions": quantity("revolutions", 1e6 * life.million, "1")?,
            "equivalent_load": quantity("equivalent_load", life.equivalent_load(), "N")?,
        });
        if let Some(hours) = life.hours() {
            section["hours"] = quantity("hours", hours, "h")?;
        }
        Ok(section)
    }
}

/// At least four digits.
fn short(value: f64) -> String {
    let exponent = value.abs().log10().floor();
    match exponent {
        small if (-3.0..7.0).contains(&small) => {
            format!("{value:.*}", (3.0 - small).max(0.0) as usize)
        }
        _ => format!("{value:.3e}"),
    }
}
