//! From `environment.waves` of a scene to the components of its seas.

use crate::algebra::fourier::Cosine;
use crate::algebra::stokes::Stokes;
use crate::scene::elevation_file::Record;
use crate::scene::types::{Environment, Seas, Waves};
use crate::sea::spectrum::{Draw, Jonswap, OchiHubble, Spectrum, Table};
use crate::sea::spreading::spread;
use crate::sea::wave::{Wave, wave_number};
use std::f64::consts::TAU;

/// What sets seas of one seed apart.
const ANOTHER: u64 = 0xd1b5_4a32_d192_ed03;

/// The components of a sea, and how it begins.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawn {
    /// The components; none where the sea is calm.
    pub waves: Vec<Wave>,
    /// Time over which they are eased in [s].
    pub ramp: f64,
    /// The steady wave that travels in place of components, of a direction and a phase [rad].
    pub steady: Option<(Stokes, [f64; 2])>,
    /// Whether frequencies and phases are random, so that crests hardly ever meet.
    pub random: bool,
}

/// The components of each sea of an environment; the same for the same scene. Seas with the same seed have other phases each.
pub fn seas(environment: &Environment) -> Vec<Drawn> {
    let seed = |index: usize, sea: &Waves| sea.seed().unwrap_or(0) ^ (index as u64).wrapping_mul(ANOTHER);
    let drawn = |(index, sea)| drawn(sea, seed(index, sea), environment.gravity, environment.depth);
    environment.waves.iter().flat_map(Seas::each).enumerate().map(drawn).collect()
}

/// The components of a sea alone, with a seed in place of its own, in water of a depth [m].
pub fn drawn(waves: &Waves, seed: u64, gravity: f64, depth: f64) -> Drawn {
    let wave = |amplitude: f64, period: f64, direction_deg: f64, phase_deg: f64| Wave {
        amplitude,
        omega: TAU / period,
        direction: direction_deg.to_radians(),
        phase: phase_deg.to_radians(),
    };
    let sea = |spectrum: &dyn Spectrum, components: &usize, direction_deg: &f64, cut_off: &Option<f64>| {
        let direction = direction_deg.to_radians();
        let mut drawn = spectrum.waves(&Draw { seed, count: *components, direction, cut_off: *cut_off });
        if let Some(spreading) = waves.spreading() {
            spread(&mut drawn, spreading.exponent(), spreading.directions, seed);
        }
        drawn
    };
    let (components, ramp, random) = match waves {
        Waves::Regular { amplitude, period, direction_deg, phase_deg, ramp, .. } => {
            (vec![wave(*amplitude, *period, *direction_deg, *phase_deg)], ramp.unwrap_or(*period), false)
        }
        Waves::Regular5th { height, period, direction_deg, phase_deg, ramp } => {
            let stokes = Stokes::new(*height, *period, gravity, depth);
            let steady = stokes.map(|stokes| (stokes, [direction_deg.to_radians(), phase_deg.to_radians()]));
            return Drawn { waves: Vec::new(), steady, ramp: ramp.unwrap_or(*period), random: false };
        }
        Waves::Jonswap { hs, tp, gamma, components, direction_deg, cut_off, ramp, .. } => {
            let spectrum = Jonswap { hs: *hs, tp: *tp, gamma: *gamma };
            (sea(&spectrum, components, direction_deg, cut_off), ramp.unwrap_or(*tp), true)
        }
        Waves::PiersonMoskowitz { hs, tp, components, direction_deg, cut_off, ramp, .. } => {
            let spectrum = Jonswap::full_grown(*hs, *tp);
            (sea(&spectrum, components, direction_deg, cut_off), ramp.unwrap_or(*tp), true)
        }
        Waves::OchiHubble { parts, components, direction_deg, cut_off, ramp, .. } => {
            let ramp = ramp.unwrap_or(parts[0].tp.max(parts[1].tp));
            (sea(&OchiHubble(*parts), components, direction_deg, cut_off), ramp, true)
        }
        Waves::Table { spectrum, components, direction_deg, cut_off, ramp, .. } => {
            let table = Table(spectrum.clone());
            let ramp = ramp.or(waves.significant().map(|(_, period)| period));
            (sea(&table, components, direction_deg, cut_off), ramp.unwrap_or(0.0), true)
        }
        Waves::Elevation { at: [x, y], direction_deg, cut_off, ramp, .. } => {
            let record = waves.record();
            let direction = direction_deg.to_radians();
            let along = x * direction.cos() + y * direction.sin();
            let of_record = |record: &Record| -> Vec<Wave> {
                // cos(ω (t - t₀) + α) at the place is cos(k (x - x₀) - ω t + φ) with φ = ω t₀ - α - k x₀.
                let component = |of: &Cosine| {
                    let omega = TAU * of.frequency;
                    let phase = omega * record.start - of.phase - wave_number(omega, gravity, depth) * along;
                    Wave { amplitude: of.amplitude, omega, direction, phase: phase.rem_euclid(TAU) }
                };
                record.up_to(record.cut_off(*cut_off)).iter().filter(|of| of.amplitude > 0.0).map(component).collect()
            };
            let ramp = ramp.or(record.as_ref().map(|record| record.peak.recip())).unwrap_or(0.0);
            (record.as_ref().map(of_record).unwrap_or_default(), ramp, true)
        }
        Waves::Components { components, ramp, .. } => {
            let waves: Vec<Wave> = components.iter().map(|c| wave(c.amplitude, c.period, c.direction_deg, c.phase_deg)).collect();
            let longest = waves.iter().map(|wave| TAU / wave.omega).fold(0.0, f64::max);
            (waves, ramp.unwrap_or(longest), false)
        }
    };
    Drawn { waves: components, steady: None, ramp, random }
}
