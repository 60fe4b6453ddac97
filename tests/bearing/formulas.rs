//! Closed forms of the bearing of chapter 2, and of the angles of (2.16).

mod frequencies {
    use bearing_dynamics::ch2_housing::bearing::frequencies::*;

    #[test]
    fn passes_of_both_races_add_up_to_one_a_ball_and_turn() {
        // Seen from the cage the races turn at −cage and 1 − cage.
        let frequencies = ratios(8, 5.955e-3, 26.0e-3, 0.3);
        let sum = frequencies.ball_pass_outer + frequencies.ball_pass_inner;
        assert!((sum - 8.0).abs() <= 1e-14, "sum {sum}");
    }

    #[test]
    fn small_balls_ride_at_half_the_shaft_speed() {
        let cage = ratios(8, 1e-9, 26.0e-3, 0.0).cage;
        assert!((cage - 0.5).abs() <= 1e-7, "cage {cage}");
    }
}

mod elliptic {
    use bearing_dynamics::ch2_housing::bearing::elliptic::*;

    #[test]
    fn legendre_relation_holds() {
        // E(m)K(m₁) + E(m₁)K(m) − K(m)K(m₁) = π/2 ties both kinds together at any m.
        for m1 in [1e-8, 1e-4, 0.01, 0.2, 0.5, 0.77] {
            let m = 1.0 - m1;
            let left = second_kind(m1) * first_kind(m) + second_kind(m) * first_kind(m1)
                - first_kind(m1) * first_kind(m);
            let error = (left - std::f64::consts::FRAC_PI_2).abs();
            // The terms are up to 10 times the result, each good to a few units in the last place.
            assert!(error <= 2e-14, "m1 = {m1}: off by {error:e}");
        }
    }

    #[test]
    fn b_and_d_add_up_to_k() {
        for m1 in [1e-10, 1e-3, 0.3, 1.0 - 1e-12, 1.0] {
            let error = (integral_b(m1) + integral_d(m1)) / first_kind(m1) - 1.0;
            assert!(error.abs() <= 4e-15, "m1 = {m1}: off by {error:e}");
        }
    }
}

mod hertz {
    use bearing_dynamics::ch2_housing::bearing::geometry::Material;
    use bearing_dynamics::ch2_housing::bearing::hertz::*;

    #[test]
    fn equal_radii_give_the_sphere_on_a_plane() {
        // Closed form for a sphere of radius R on a plane: F = (4/3) E* √R δ^1.5 with E* = E'/2,
        // here with both relative radii equal to R.
        let (radius, modulus) = (0.01, 200e9);
        let contact = contact_from_radii(HertzModel::Exact, radius, radius, modulus).unwrap();
        let closed_form = 4.0 / 3.0 * (modulus / 2.0) * f64::sqrt(radius);
        assert!((contact.stiffness / closed_form - 1.0).abs() <= 1e-14);
        assert!((contact.ellipticity - 1.0).abs() <= 1e-15);
    }

    #[test]
    fn a_ceramic_ball_on_a_steel_race_counts_with_both_materials() {
        use bearing_dynamics::ch2_housing::bearing::geometry::BearingGeometry;
        let geometry =
            BearingGeometry::deep_groove(8, 20.047e-3, 6.013e-3, 31.953e-3, 6.310e-3, 5.953e-3);
        let steel = Material { youngs_modulus: 210e9, poisson_ratio: 0.3, density: 7850.0 };
        let nitride = Material { youngs_modulus: 310e9, poisson_ratio: 0.27, density: 3200.0 };
        // 1 − 0.3² = 0.91 and 1 − 0.27² = 0.9271, over the moduli in GPa.
        let hybrid = 2e9 / (0.9271 / 310.0 + 0.91 / 210.0);
        for side in [RaceSide::Inner, RaceSide::Outer] {
            for model in [HertzModel::HamrockBrewe, HertzModel::Exact] {
                let found = contact(model, side, &geometry, &nitride, &steel).unwrap();
                assert!((found.effective_modulus / hybrid - 1.0).abs() <= 1e-14);
                // K_H is proportional to E', which for steel on steel is 210 GPa/0.91.
                let all_steel = contact(model, side, &geometry, &steel, &steel).unwrap();
                let ratio = found.stiffness / all_steel.stiffness;
                assert!((ratio / (hybrid * 0.91 / 210e9) - 1.0).abs() <= 1e-14, "{ratio}");
            }
        }
    }

    #[test]
    fn exchanging_the_directions_changes_nothing() {
        for model in [HertzModel::HamrockBrewe, HertzModel::Exact] {
            let one = contact_from_radii(model, 0.004, 0.3, 2e11).unwrap();
            let other = contact_from_radii(model, 0.3, 0.004, 2e11).unwrap();
            assert_eq!(one.stiffness, other.stiffness);
        }
    }

    #[test]
    fn a_ball_as_large_as_its_groove_is_refused() {
        let error = contact_from_radii(HertzModel::Exact, 0.004, f64::INFINITY, 2e11);
        assert!(matches!(error, Err(HertzError::NotConvex { .. })));
        assert!(contact_from_radii(HertzModel::Exact, f64::NAN, 1.0, 2e11).is_err());
    }
}

mod slices {
    use bearing_dynamics::ch2_housing::bearing::slices::*;
    use bearing_dynamics::ch2_housing::bearing::traction::TractionLaw;
    use core::f64::consts::PI;

    /// An ellipse without width.
    fn line(semi_major: f64) -> Patch {
        Patch { semi_major, semi_minor: 0.0, half_curvature: 0.0 }
    }

    #[test]
    fn pure_spin_gives_three_eighths_of_the_moment() {
        // ∫ κ q(y) |y| dy = 3κWa/8 for constant κ, any slip direction the same size.
        let law = TractionLaw::Constant { coefficient: 0.07, regularisation_speed: 1e-12 };
        let sliding = Sliding { relative_spin: [0.0, 0.0, 30.0], ..Sliding::default() };
        let semi_major = 1.5e-3;
        let mut errors = Vec::new();
        for count in [15, 45, 135] {
            let sum = integrate(&law, &Slices::new(count, 1), &sliding, &line(semi_major));
            let exact = -3.0 * 0.07 * semi_major / 8.0;
            errors.push((sum.moment / exact - 1.0).abs());
            assert!(sum.rolling.abs() <= 1e-15 && sum.transverse.abs() <= 1e-15);
        }
        // Slices of equal width: second order.
        assert!(errors[0] <= 6e-3, "{errors:?}");
        for pair in errors.windows(2) {
            let order = (pair[0] / pair[1]).ln() / 3f64.ln();
            assert!((order - 2.0).abs() <= 0.15, "{errors:?}");
        }
    }

    /// A ball that rolls freely in its groove slips to and fro: on y = ±c not at all, with c − c³/3 = 1/3 without a net
    /// force. Its rolling resistance is then κ W a²/(2 R_p) · 3/2 (∫_c^1 − ∫_0^c) η² (1 − η²) dη, some 0.08 κ W a²/R_p.
    #[test]
    fn differential_sliding_resists_rolling_as_in_closed_form() {
        let law = TractionLaw::Constant { coefficient: 0.07, regularisation_speed: 1e-12 };
        let (semi_major, spin, radius) = (1.5e-3, 400.0, 6e-3);
        let half_curvature = 0.5 / radius;
        let patch = Patch { semi_major, semi_minor: 0.2e-3, half_curvature };
        let mut line = 0.3;
        for _ in 0..50 {
            line = 1.0 / 3.0 + line * line * line / 3.0;
        }
        let integral = |to: f64| to.powi(3) / 3.0 - to.powi(5) / 5.0;
        let parts = integral(1.0) - 2.0 * integral(line);
        let exact = 0.07 * semi_major * semi_major * half_curvature * 1.5 * parts;
        assert!((exact / (0.07 * semi_major * semi_major / radius) - 0.08).abs() <= 1e-3);
        // Slip at the centre that leaves no force.
        let slip = half_curvature * (line * semi_major).powi(2) * spin;
        let sliding =
            Sliding { slip: [slip, 0.0], relative_spin: [0.0, spin, 0.0], ..Sliding::default() };
        let mut errors = Vec::new();
        for count in [45, 135, 405] {
            let sum = integrate(&law, &Slices::new(count, 1), &sliding, &patch);
            assert!(sum.rolling.abs() <= 0.07 * 2.0 / count as f64, "{sum:?}");
            // Dissipated by the spin alone, as there is no force.
            let power = -sum.moment_s * spin - sum.rolling * slip;
            assert!((power + sum.power).abs() <= 1e-12 * power.abs().max(1e-12), "{sum:?}");
            errors.push((-(sum.moment_s * spin + sum.rolling * slip) / (exact * spin) - 1.0).abs());
        }
        assert!(errors[0] <= 1e-2 && errors[2] <= 1e-3, "{errors:?}");
    }

    #[test]
    fn spin_on_a_whole_ellipse_has_its_elliptic_integral() {
        // ∫ κ q r dA = 3κWa E(e)/8: Hertz's pressure is the same on every ray of the ellipse.
        let law = TractionLaw::Constant { coefficient: 0.07, regularisation_speed: 1e-12 };
        let sliding = Sliding { relative_spin: [0.0, 0.0, 30.0], ..Sliding::default() };
        for ratio in [0.2, 0.5, 1.0] {
            let patch =
                Patch { semi_major: 1.5e-3, semi_minor: 1.5e-3 * ratio, half_curvature: 0.0 };
            let steps = 1000;
            let angles = (0..steps).map(|i| (PI * i as f64 / steps as f64).sin_cos());
            let integral =
                angles.map(|(s, c)| s.hypot(ratio * c)).sum::<f64>() * PI / (2 * steps) as f64;
            let exact = -3.0 * 0.07 * patch.semi_major * integral / 8.0;
            let errors = [10, 20, 40].map(|count| {
                let sum = integrate(&law, &Slices::new(count, count), &sliding, &patch);
                (sum.moment / exact - 1.0).abs()
            });
            // Even numbers: no point lies in the middle, where the slip turns round.
            assert!(errors[0] <= 1e-2 && errors[2] <= 8e-4, "{ratio}: {errors:?}");
            for pair in errors.windows(2) {
                assert!((pair[0] / pair[1]).log2() >= 1.8, "{ratio}: {errors:?}");
            }
            // Along and across are alike on a circle.
            if ratio == 1.0 {
                let slip = [6e-2, 2e-2];
                let turned = [-slip[1], slip[0]];
                let [one, other] = [slip, turned].map(|slip| {
                    let sliding = Sliding { slip, ..sliding };
                    integrate(&law, &Slices::new(400, 60), &sliding, &patch)
                });
                let off =
                    (one.rolling - other.transverse).abs() + (one.transverse + other.rolling).abs();
                assert!(off <= 1e-5 * one.rolling.hypot(one.transverse), "{one:?} {other:?}");
            }
        }
    }

    #[test]
    fn shares_add_up_to_the_load() {
        for count in [1, 2, 15, 101] {
            for across in 1..=9 {
                let sum: f64 = Slices::new(count, across).share.iter().sum();
                assert!((sum - 1.0).abs() <= 1e-14);
            }
        }
    }
}

mod inertia {
    use bearing_dynamics::ch2_housing::bearing::inertia::*;
    use std::f64::consts::PI;

    #[test]
    fn a_ring_without_groove_is_a_hollow_cylinder() {
        let exact = hollow_cylinder(15e-3, 20e-3, 20e-3, 7850.0);
        // The groove's circle lies outside the material.
        let ring = grooved_ring(15e-3, 20e-3, 30e-3, 6e-3, 20e-3, 7850.0);
        for (a, b) in [
            (ring.mass, exact.mass),
            (ring.axial, exact.axial),
            (ring.transverse, exact.transverse),
        ] {
            assert!((a / b - 1.0).abs() <= 1e-13);
        }
    }

    #[test]
    fn the_groove_takes_away_the_volume_of_pappus() {
        // A groove cut half a circle deep at the land: volume by Pappus, 2π(R − 4r/3π)·πr²/2.
        let (land, radius) = (22e-3, 3e-3);
        let ring = grooved_ring(15e-3, land, land, radius, 20e-3, 1000.0);
        let full = hollow_cylinder(15e-3, land, 20e-3, 1000.0);
        let centroid = land - 4.0 * radius / (3.0 * PI);
        let volume = 2.0 * PI * centroid * 0.5 * PI * radius * radius;
        // The circular profile has a vertical tangent at its edge: Gauss converges slowly there.
        assert!(((full.mass - ring.mass) / (1000.0 * volume) - 1.0).abs() <= 2e-3);
    }
}

mod traction {
    use bearing_dynamics::ch2_housing::bearing::traction::*;

    #[test]
    fn exponential_is_good_to_two_ulp() {
        let mut worst = 0.0_f64;
        for step in 0..200_000 {
            let x = -700.0 * (step as f64 / 200_000.0).powi(3);
            worst = worst.max((exp_of_negative(x) / libm::exp(x) - 1.0).abs());
        }
        assert!(worst <= 2.0 * f64::EPSILON, "off by {worst:e}");
        assert_eq!(exp_of_negative(0.0), 1.0);
        assert!(exp_of_negative(-1e6) >= 0.0 && exp_of_negative(-1e6) < 1e-300);
        assert!(exp_of_negative(f64::NAN).is_nan());
    }

    #[test]
    fn boundary_curve_peaks_where_its_derivative_says() {
        let curve = ExponentialCurve::BOUNDARY;
        // dκ/ds = 0 at s = (1 + c d/b)/c.
        let peak = (1.0 + curve.c * curve.d / curve.b) / curve.c;
        let at = curve.coefficient(peak);
        assert!((at - 0.12).abs() <= 5e-4, "peak {at} at {peak}");
        assert!(curve.coefficient(peak * 0.99) < at && curve.coefficient(peak * 1.01) < at);
        assert_eq!(curve.coefficient(0.0), 0.0);
    }

    /// From rest, where it is the slope, over speeds far below the rounding and far above it.
    #[test]
    fn rounded_friction_needs_no_division_by_the_speed() {
        let (share, kappa, u0) = (0.3, 0.07, 0.02);
        let [at_rest, power] = rounded_resistance(0.0, share, kappa, u0);
        assert!((at_rest / (share * kappa / u0) - 1.0).abs() <= 1e-15, "{at_rest}");
        assert_eq!(power, 0.0);
        let law = TractionLaw::Constant { coefficient: kappa, regularisation_speed: u0 };
        for exponent in -120..40 {
            let square = libm::exp2(0.5 * f64::from(exponent));
            let own = rounded_resistance(square, share, kappa, u0);
            let by_speed = resistance(square, share, |speed| coefficient(&law, speed, 1.0));
            for (a, b) in own.into_iter().zip(by_speed) {
                // Four roundings of one way, eight of the other.
                assert!((a / b - 1.0).abs() <= 8.0 * f64::EPSILON, "{square:e}: {a} {b}");
            }
            let own = rounded_steepness(square, share, kappa, u0);
            let by_speed =
                steepness(square, share, |speed| coefficient_and_slope(&law, speed, 1.0));
            assert!((own[0] / by_speed[0] - 1.0).abs() <= 8.0 * f64::EPSILON, "{square:e}");
            // What sliding along adds is a difference in the one way: rounding over the square of a speed that is far below the
            // rounding's.
            let error = (own[1] - by_speed[1]).abs() * square;
            assert!(error <= 8.0 * f64::EPSILON * own[0], "{square:e}: {error:e}");
        }
    }
}

mod euler {
    use bearing_dynamics::kinematics::euler::*;
    use nalgebra::Matrix3;

    /// (2.16) as it is printed.
    fn inertial_to_body(eta: f64, xi: f64, lambda: f64) -> Matrix3<f64> {
        let (sin_eta, cos_eta) = libm::sincos(eta);
        let (sin_xi, cos_xi) = libm::sincos(xi);
        let (sin_lambda, cos_lambda) = libm::sincos(lambda);
        Matrix3::new(
            cos_xi * cos_lambda,
            cos_eta * sin_lambda + sin_eta * sin_xi * cos_lambda,
            sin_eta * sin_lambda - cos_eta * sin_xi * cos_lambda,
            -cos_xi * sin_lambda,
            cos_eta * cos_lambda - sin_eta * sin_xi * sin_lambda,
            sin_eta * cos_lambda + cos_eta * sin_xi * sin_lambda,
            sin_xi,
            -sin_eta * cos_xi,
            cos_eta * cos_xi,
        )
    }

    #[test]
    fn matrix_of_2_16_is_the_transpose_of_the_quaternion() {
        let (eta, xi, lambda) = (0.3, -0.7, 1.1);
        let printed = inertial_to_body(eta, xi, lambda);
        let rotation = quaternion(eta, xi, lambda).to_rotation_matrix();
        assert!((printed - rotation.matrix().transpose()).amax() <= 4.0 * f64::EPSILON);
    }

    #[test]
    fn angles_invert_the_quaternion_also_at_the_pole() {
        for given in [(0.3, -0.7, 1.1), (-2.0, 1.2, -3.0), (0.0, 0.0, 0.0)] {
            let (eta, xi, lambda) = angles(&quaternion(given.0, given.1, given.2));
            let error = (eta - given.0).abs() + (xi - given.1).abs() + (lambda - given.2).abs();
            assert!(error <= 1e-14, "{given:?} came back as {:?}", (eta, xi, lambda));
        }
        let pole = quaternion(0.4, std::f64::consts::FRAC_PI_2, 0.2);
        let (eta, xi, lambda) = angles(&pole);
        assert!(pole.angle_to(&quaternion(eta, xi, lambda)) <= 1e-7);
    }
}
