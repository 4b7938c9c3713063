//! From `environment.waves` of a scene to the components of its seas.

use crate::scene::types::{Seas, Waves};
use crate::sea::spectrum::{Draw, Jonswap, OchiHubble, Spectrum, Table};
use crate::sea::spreading::spread;
use crate::sea::wave::Wave;
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
    /// Whether frequencies and phases are random.
    pub random: bool,
}

/// The components of each sea of a scene; the same for the same scene. Seas with the same seed have other phases each.
pub fn seas(seas: &Seas) -> Vec<Drawn> {
    let each = seas.each().iter().enumerate();
    each.map(|(index, sea)| drawn_as(sea, sea.seed().unwrap_or(0) ^ (index as u64).wrapping_mul(ANOTHER))).collect()
}

/// The components of a sea alone.
pub fn drawn(waves: &Waves) -> Drawn {
    drawn_as(waves, waves.seed().unwrap_or(0))
}

/// The components of a sea with a seed in place of its own.
fn drawn_as(waves: &Waves, seed: u64) -> Drawn {
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
        Waves::Components { components, ramp, .. } => {
            let waves: Vec<Wave> = components.iter().map(|c| wave(c.amplitude, c.period, c.direction_deg, c.phase_deg)).collect();
            let longest = waves.iter().map(|wave| TAU / wave.omega).fold(0.0, f64::max);
            (waves, ramp.unwrap_or(longest), false)
        }
    };
    Drawn { waves: components, ramp, random }
}
