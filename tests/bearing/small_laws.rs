//! Laws of single functions of the solver: courses in time, slopes of energies, what a ledger ends.

mod profile {
    use bearing_dynamics::numeric::profile::*;

    #[test]
    fn rates_are_the_derivatives_of_the_values() {
        let profiles = [
            Profile::Ramp { from: 1.0, to: 3.0, start: 0.2, duration: 0.5 },
            Profile::SmoothRamp { from: 1.0, to: -3.0, start: 0.2, duration: 0.5 },
            Profile::Table { points: vec![[0.0, 1.0], [0.3, 2.0], [0.9, -1.0]] },
            Profile::Harmonic { mean: 2.0, amplitude: 0.5, frequency: 3.0, phase: 0.4 },
            Profile::HalfSine { base: 1.0, peak: 5.0, start: 0.3, duration: 0.4 },
        ];
        let step = 1e-5;
        for profile in profiles {
            for k in 0..97 {
                let t = 0.0101 * k as f64;
                if profile.corners().iter().any(|corner| (t - corner).abs() < 2.0 * step) {
                    continue;
                }
                let slope = (profile.value(t + step) - profile.value(t - step)) / (2.0 * step);
                let error = (slope - profile.rate(t)).abs();
                // Third derivative · step²/6, at most 3350·1e-10/6 for the harmonic.
                assert!(error <= 1e-6, "{profile:?} at {t}: {error}");
                let bend = (profile.rate(t + step) - profile.rate(t - step)) / (2.0 * step);
                let error = (bend - profile.acceleration(t)).abs();
                // The same for the fourth derivative: 63000·1e-10/6.
                assert!(error <= 1e-5, "{profile:?} at {t}: {error}");
            }
        }
    }

    #[test]
    fn integrals_have_the_values_as_their_derivative() {
        let profiles = [
            Profile::Constant(3.0),
            Profile::Ramp { from: 1.0, to: 3.0, start: 0.2, duration: 0.5 },
            Profile::Ramp { from: 1.0, to: 3.0, start: -0.2, duration: 0.5 },
            Profile::Ramp { from: 1.0, to: 3.0, start: 0.3, duration: 0.0 },
            Profile::SmoothRamp { from: 1.0, to: -3.0, start: 0.2, duration: 0.5 },
            Profile::Table { points: vec![[0.1, 1.0], [0.3, 2.0], [0.9, -1.0]] },
            Profile::Table { points: vec![[-0.1, 1.0], [0.3, 2.0], [0.9, -1.0]] },
            Profile::Harmonic { mean: 2.0, amplitude: 0.5, frequency: 3.0, phase: 0.4 },
            Profile::HalfSine { base: 1.0, peak: 5.0, start: 0.3, duration: 0.4 },
            Profile::HalfSine { base: 1.0, peak: 5.0, start: -0.1, duration: 0.4 },
        ];
        let step = 1e-5;
        for profile in profiles {
            assert_eq!(profile.integral(0.0), 0.0, "{profile:?}");
            for k in 0..97 {
                let t = 0.0101 * k as f64;
                if profile.corners().iter().any(|corner| (t - corner).abs() < 2.0 * step) {
                    continue;
                }
                let sum = (profile.integral(t + step) - profile.integral(t - step)) / (2.0 * step);
                let error = (sum - profile.value(t)).abs();
                // Second derivative · step²/6, at most 310·1e-10/6, and rounding of 2e-16/1e-5.
                assert!(error <= 1e-8, "{profile:?} at {t}: {error}");
            }
        }
    }

    #[test]
    fn ramps_meet_their_ends() {
        let ramp = Profile::SmoothRamp { from: 1.0, to: 4.0, start: 1.0, duration: 2.0 };
        assert_eq!((ramp.value(0.0), ramp.value(3.0), ramp.value(9.0)), (1.0, 4.0, 4.0));
        let step = Profile::Ramp { from: 0.0, to: 2.0, start: 1.0, duration: 0.0 };
        assert_eq!((step.value(0.999), step.value(1.0), step.rate(1.0)), (0.0, 2.0, 0.0));
    }
}

mod static_seat {
    use bearing_dynamics::equilibrium::housing_fit::*;
    use bearing_dynamics::kinematics::Pose;
    use bearing_dynamics::members::mount::Mount;
    use bearing_dynamics::members::race_position::InnerRacePosition;
    use nalgebra::UnitQuaternion;
    use nalgebra::{SMatrix, Vector3, Vector4, Vector5};
    use std::f64::consts::PI;

    /// Over the pose of a race in its bore, of numbers with nothing of symmetry.
    fn quadratic(pose: [f64; 4]) -> (f64, Vector4<f64>, SMatrix<f64, 4, 4>) {
        let stiffness = SMatrix::<f64, 4, 4>::from_fn(|i, j| {
            let (low, high) = (i.min(j) as f64, i.max(j) as f64);
            if i == j { 3.0 + low } else { 0.4 * low - 0.3 * high }
        });
        let gone = Vector4::from(pose) - Vector4::new(0.3, -0.2, 0.5, -0.6);
        (0.5 * gone.dot(&(stiffness * gone)), stiffness * gone, stiffness)
    }

    /// Turned far more than a bore leaves room for, so that every term counts.
    #[test]
    fn load_and_stiffness_over_a_bodys_coordinates_are_slopes_of_the_energy() {
        let lean = UnitQuaternion::from_scaled_axis(Vector3::new(0.4, 0.3, -0.2));
        let over = UnitQuaternion::from_scaled_axis(Vector3::new(0.0, 0.0, PI));
        for (along, reversed) in [(0.0, false), (0.2, false), (-0.3, true)] {
            let orientation = if reversed { over * lean } else { lean };
            let axes = Pose { position: Vector3::new(0.01, -0.02, 0.03), orientation };
            let turn = orientation.to_rotation_matrix().into_inner();
            let mount = Mount { body: 0, along, reversed };
            let place = |at: &Vector5<f64>| {
                let race = InnerRacePosition::mounted(at, &mount, &Vector3::zeros());
                SeatPlace::new(race.seen_from_parent_of(&axes), &mount, &turn)
            };
            let here = Vector5::from([0.05, -0.1, 0.15, 0.3, -0.4]);
            let found = place(&here);
            let (_, load, stiffness) = quadratic(found.pose);
            let (own_load, own) = (found.load(&load), found.stiffness(&stiffness, &load, &mount));
            for i in 0..5 {
                let step = 1e-6;
                let moved = |sign: f64| {
                    let mut at = here;
                    at[i] += sign * step;
                    let there = place(&at);
                    let (energy, load, _) = quadratic(there.pose);
                    (energy, there.load(&load))
                };
                let (high, low) = (moved(1.0), moved(-1.0));
                // Rounding of numbers near one over the step, and its square.
                let slope = (high.0 - low.0) / (2.0 * step);
                assert!((slope - own_load[i]).abs() <= 1e-8, "{along} {i}: {slope} {own_load}");
                let slopes = (high.1 - low.1) / (2.0 * step);
                let apart = (slopes - own.column(i)).amax();
                assert!(apart <= 1e-8, "{along} {i}: {slopes} {own}");
            }
        }
    }
}

mod static_shaft {
    use bearing_dynamics::equilibrium::lists::StaticSection;
    use bearing_dynamics::equilibrium::shaft::*;
    use bearing_dynamics::members::flexible_shaft::Section;
    use nalgebra::Vector5;

    fn section() -> StaticSection {
        let section = Section {
            along: 0.21,
            deflection: vec![0.7, -0.4],
            turn: vec![3.1, 5.2],
            stretch: vec![0.6],
            shortening: vec![2.0, -0.7, -0.7, 1.5],
        };
        StaticSection { shaft: 0, section, loads: [0.0; 5] }
    }

    /// Body and two shapes either way and one along.
    fn place(at: &[f64]) -> SectionPlace {
        SectionPlace::new(&section(), &Vector5::from_column_slice(&at[..5]), &at[5..])
    }

    /// Turned as far as a shaft may, so that what the second order leaves out shows.
    #[test]
    fn motion_and_curvature_are_slopes_of_a_sections_place() {
        let of = section();
        let here = [1e-3, -2e-3, 3e-3, 0.2, -0.3, 2e-3, -3e-3, -1e-3, 4e-3, 1e-3];
        let gradient = Vector5::from([3.0, -1.0, 2.0, 0.5, -0.7]);
        let moved = |column: usize, by: f64| {
            let mut at = here;
            at[column] += by;
            place(&at)
        };
        let found = place(&here);
        let slopes = found.slopes(&of);
        let (motion, tilts) = found.motion(&slopes);
        let curved = found.curvature(&of, &gradient, &slopes, (&motion, &tilts));
        let step = 1e-6;
        for column in 0..here.len() {
            let (high, low) = (moved(column, step), moved(column, -step));
            let slope = (high.coordinates - low.coordinates) / (2.0 * step);
            let off = (slope - motion.column(column)).amax();
            assert!(off <= 1e-8, "{column}: {slope} {motion}");
            let of_gradient = |place: &SectionPlace| {
                let (motion, _) = place.motion(&place.slopes(&of));
                motion.tr_mul(&gradient)
            };
            let bends = (of_gradient(&high) - of_gradient(&low)) / (2.0 * step);
            let off = (bends - curved.column(column)).amax();
            // The turns of 0.03 rad square to 1e-3 of numbers below 40.
            assert!(off <= 3e-2, "{column}: {off:e} {curved}");
        }
    }
}

mod ledger_watch {
    use bearing_dynamics::assembly::ledger_watch::*;

    /// Rows on end that are seen until a run ends, at most a hundred.
    fn rows_seen(residual: f64, turned_over: f64) -> usize {
        let mut watch = LedgerWatch::default();
        (0..100).take_while(|_| watch.record(residual, turned_over, 0.0, 0.2)).count()
    }

    /// Looks that are open now and then end no run, those on end do.
    #[test]
    fn a_single_blow_ends_no_run() {
        let mut watch = LedgerWatch::default();
        for round in 0..20 {
            let open = (1..MOST_OPEN).all(|_| watch.record(1.0, 2.0, 0.0, 0.2));
            assert!(open && watch.record(0.1, 2.0, 0.0, 0.2), "{round}");
        }
        assert_eq!((watch.largest_residual, watch.turned_over), (1.0, 2.0));
    }

    /// Rounding of the energy that a loaded shaft holds at rest ends no run; a millionth of it does.
    #[test]
    fn rounding_of_what_is_held_is_no_loss() {
        let rows = |residual: f64| {
            let mut watch = LedgerWatch::default();
            (0..100).take_while(|_| watch.record(residual, 1e-18, 0.03, 0.01)).count()
        };
        assert_eq!(rows(2e-17), 100);
        assert!(rows(3e-8) < 10);
    }

    /// As of a rotor at rest in elements, whose load comes later: 1.6e-23 J of 3.3e-23 J.
    #[test]
    fn rounding_of_a_system_at_rest_ends_no_run() {
        assert_eq!(rows_seen(1.6e-23, 3.3e-23), 100);
        assert_eq!(rows_seen(1.6e-9, 3.3e-9), MOST_OPEN as usize - 1);
        assert_eq!(rows_seen(1.6e-23, 0.0), 100);
        assert_eq!(rows_seen(f64::NAN, 1.0), 0);
    }
}

mod tally {

    use bearing_dynamics::plan::Stage;

    #[test]
    fn every_stage_has_its_number() {
        for (number, stage) in Stage::ALL.into_iter().enumerate() {
            assert_eq!(stage as usize, number, "{stage:?}");
        }
    }
}
