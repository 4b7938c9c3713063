//! A filter for measured positions, whose noise would be taken for motion (`input.filter`).
//!
//! ```text
//! x_f″ = ω² (x - x_f) - 2 ω x_f′,   ω = 2 π f
//! ```
//!
//! x the positions as given, on straight lines between communication points [m], f the cut-off [Hz]; solved exactly over a step. x_f and x_f′
//! take the places of position and velocity. A slow motion passes with a delay of 2/ω = 1/(π f); at the cut-off half of the amplitude is left,
//! beyond it 12 dB less per octave. Velocities and derivatives that are given are not looked at.

use crate::fmi::inputs::Inputs;
use std::f64::consts::TAU;

/// Where the filter stands. Part of the FMU state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Filter {
    /// Time of the last positions [s].
    pub time: f64,
    /// The last positions [m].
    pub given: [f64; 3],
    /// x_f [m].
    pub position: [f64; 3],
    /// x_f′ [m/s].
    pub velocity: [f64; 3],
}

impl Filter {
    /// A fairlead at rest.
    pub fn at_rest(position: [f64; 3], time: f64) -> Filter {
        Filter { time, given: position, position, velocity: [0.0; 3] }
    }

    /// The filter after positions at a time; `cutoff`: f [Hz].
    pub fn after(&self, cutoff: f64, time: f64, inputs: &Inputs) -> Filter {
        let step = time - self.time;
        if !(step > 0.0) {
            return Filter { given: inputs.values[0], ..*self };
        }
        let omega = TAU * cutoff;
        let (mut after, decay) = (Filter { time, given: inputs.values[0], ..*self }, (-omega * step).exp());
        for axis in 0..3 {
            let rate = (after.given[axis] - self.given[axis]) / step;
            // A ramp is followed at a distance of 2 r/ω; what is off from that dies away as (A + B s) e^(-ω s).
            let off = self.position[axis] - (self.given[axis] - 2.0 * rate / omega);
            let slope = self.velocity[axis] - rate + omega * off;
            let left = (off + slope * step) * decay;
            after.position[axis] = after.given[axis] - 2.0 * rate / omega + left;
            after.velocity[axis] = rate + slope * decay - omega * left;
        }
        after
    }

    /// What the path goes by.
    pub fn inputs(&self) -> Inputs {
        Inputs { values: [self.position, self.velocity], ..Inputs::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run(cutoff: f64, step: f64, motion: impl Fn(f64) -> f64, until: f64) -> Filter {
        let mut filter = Filter::at_rest([motion(0.0), 0.0, 0.0], 0.0);
        for number in 1..=(until / step).round() as u32 {
            let time = f64::from(number) * step;
            filter = filter.after(cutoff, time, &Inputs { values: [[motion(time), 0.0, 0.0], [0.0; 3]], ..Inputs::default() });
        }
        filter
    }

    /// A ramp is delayed by 1/(π f) and nothing else; at the cut-off the amplitude of a sine is halved and turned by a quarter.
    #[test]
    fn delay_and_cut_off_are_what_is_promised() {
        let ramp = run(0.5, 0.1, |t| 2.0 * t, 30.0);
        assert!(
            (ramp.position[0] - 2.0 * (30.0 - 1.0 / (std::f64::consts::PI * 0.5))).abs() < 1e-9
                && (ramp.velocity[0] - 2.0).abs() < 1e-9
        );
        let sine = |t: f64| (TAU * 0.5 * t).sin();
        let (at_quarter, at_half) = (run(0.5, 0.001, sine, 20.5), run(0.5, 0.001, sine, 21.0));
        assert!(at_quarter.position[0].abs() < 1e-4 && (at_half.position[0] - 0.5).abs() < 1e-4, "{at_quarter:?} {at_half:?}");
    }

    /// How the time is divided does not matter.
    #[test]
    fn steps_of_any_size_give_the_same() {
        let (one, other) = (run(0.3, 0.1, |t| t.min(2.0), 6.0), run(0.3, 0.02, |t| t.min(2.0), 6.0));
        assert!((one.position[0] - other.position[0]).abs() < 1e-12 && (one.velocity[0] - other.velocity[0]).abs() < 1e-12);
    }
}
