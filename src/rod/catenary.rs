//! Elastic catenary in closed form (Irvine 1981), hanging free or lying partly on a rigid bed: the first guess of statics.
//!
//! s from the anchor [m], H horizontal tension [N], V(s) = V_A + w s its vertical part [N], w weight in water [N/m]:
//!
//! ```text
//! x(s) = H s/EA + (H/w) [asinh(V/H) - asinh(V_A/H)]
//! z(s) = (V_A s + w s²/2)/EA + (1/w) [√(H² + V²) - √(H² + V_A²)]
//! ```
//!
//! On the bed V = 0 and x' = 1 + H/EA. A line too long for any H > 0 hangs in vertical legs and lies on the bed in an arc.
//! A line that floats is the same problem upside down, with the water surface as its bed.

use crate::algebra::root;
use nalgebra::{Vector2, Vector3};

/// A uniform line between two points, in the vertical plane through them; heights above a flat bed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// Horizontal distance [m].
    pub distance: f64,
    /// Height of the anchor above the bed [m].
    pub anchor_height: f64,
    /// Height of the fairlead above the bed [m].
    pub fairlead_height: f64,
    /// Unstretched length [m].
    pub length: f64,
    /// Weight in water [N/m], > 0.
    pub weight: f64,
    /// EA [N].
    pub ea: f64,
}

/// The shape of a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Catenary {
    /// Free of the bed.
    Hanging {
        /// Horizontal tension [N].
        horizontal: f64,
        /// Vertical part of the tension at the anchor [N]; negative: the line leaves it downwards.
        at_anchor: f64,
    },
    /// Partly on the bed, taut along it.
    Lying {
        /// Horizontal tension [N].
        horizontal: f64,
        /// Vertical part at the anchor, ≥ 0 [N].
        at_anchor: f64,
        /// Vertical part at the fairlead, ≥ 0 [N].
        at_fairlead: f64,
    },
    /// Too long to be taut anywhere on the bed.
    Piled,
}

impl Span {
    /// The shape in equilibrium.
    pub fn solve(&self) -> Catenary {
        let hanging = self.hanging();
        let Catenary::Hanging { horizontal, at_anchor } = hanging else { return hanging };
        let lowest = (-at_anchor / self.weight).clamp(0.0, self.length);
        if self.anchor_height + self.curve(horizontal, at_anchor, lowest).y >= -1e-9 * self.length {
            return hanging;
        }
        self.lying()
    }

    /// Place at s relative to the anchor, hanging free.
    fn curve(&self, h: f64, v_a: f64, s: f64) -> Vector2<f64> {
        let (w, v) = (self.weight, v_a + self.weight * s);
        let x = h * s / self.ea + h / w * ((v / h).asinh() - (v_a / h).asinh());
        // √(H²+V²) - √(H²+V_A²) without cancellation
        let rise = (v - v_a) * (v + v_a) / (h.hypot(v) + h.hypot(v_a));
        Vector2::new(x, (v_a * s + 0.5 * w * s * s) / self.ea + rise / w)
    }

    fn hanging(&self) -> Catenary {
        let rise = self.fairlead_height - self.anchor_height;
        let weight = self.weight * self.length;
        let strained = self.ea * (rise.abs() + self.distance) / self.length;
        let vertical = |h: f64| {
            let limit = 2.0 * (weight + strained);
            root::of_rising(-limit, limit, |v_a| self.curve(h, v_a, self.length).y - rise)
        };
        let excess = |h: f64| self.curve(h, vertical(h), self.length).x - self.distance;
        let mut high = 1.0e-6 * weight;
        while excess(high) < 0.0 && high < 1e6 * (weight + strained) {
            high *= 4.0;
        }
        let horizontal = root::of_rising(0.0, high, |h| if h > 0.0 { excess(h) } else { -1.0 }).max(1e-9 * weight);
        Catenary::Hanging { horizontal, at_anchor: vertical(horizontal) }
    }

    /// Vertical tension that lifts a leg by `height` at horizontal tension h.
    fn leg(&self, h: f64, height: f64) -> f64 {
        let rigid = (self.weight * height * (self.weight * height + 2.0 * h)).sqrt();
        let lift = |v: f64| v * v / (2.0 * self.weight * self.ea) + v * v / (h.hypot(v) + h) / self.weight;
        root::of_rising(0.0, rigid, |v| if v > 0.0 { lift(v) - height } else { -1.0 })
    }

    fn lying(&self) -> Catenary {
        let reach = |h: f64| {
            let (v_a, v_f) = (self.leg(h, self.anchor_height), self.leg(h, self.fairlead_height));
            let on_bed = self.length - (v_a + v_f) / self.weight;
            let leg = |v: f64| h / self.ea * v / self.weight + h / self.weight * (v / h).asinh();
            (leg(v_a) + leg(v_f) + on_bed.max(0.0) * (1.0 + h / self.ea), on_bed)
        };
        let smallest = 1.0e-9 * self.weight * self.length;
        if reach(smallest).0 >= self.distance || reach(smallest).1 <= 0.0 {
            return Catenary::Piled;
        }
        let mut high = smallest;
        while reach(high).0 < self.distance && reach(high).1 > 0.0 {
            high *= 4.0;
        }
        let horizontal = root::of_rising(smallest, high, |h| {
            let (reached, on_bed) = reach(h);
            if on_bed < 0.0 { 1.0 } else { reached - self.distance }
        });
        Catenary::Lying {
            horizontal,
            at_anchor: self.leg(horizontal, self.anchor_height),
            at_fairlead: self.leg(horizontal, self.fairlead_height),
        }
    }

    /// Place (x from the anchor, height above the bed, sideways) and slope dr/ds at s from the anchor.
    pub fn at(&self, shape: &Catenary, s: f64) -> (Vector3<f64>, Vector3<f64>) {
        let slope = |h: f64, v: f64| {
            let stretch = 1.0 / self.ea + 1.0 / h.hypot(v).max(f64::MIN_POSITIVE);
            Vector3::new(h * stretch, v * stretch, 0.0)
        };
        match *shape {
            Catenary::Hanging { horizontal, at_anchor } => {
                let place = self.curve(horizontal, at_anchor, s);
                let z = self.anchor_height + place.y;
                (Vector3::new(place.x, z, 0.0), slope(horizontal, at_anchor + self.weight * s))
            }
            Catenary::Lying { horizontal, at_anchor, at_fairlead } => {
                let (s_a, s_f) = (at_anchor / self.weight, self.length - at_fairlead / self.weight);
                let foot = self.curve(horizontal, -at_anchor, s_a.min(s));
                let flat = Vector2::new((s.min(s_f) - s_a).max(0.0) * (1.0 + horizontal / self.ea), 0.0);
                let rising = self.curve(horizontal, 0.0, (s - s_f).max(0.0));
                let place = foot + flat + rising;
                let v = if s < s_a { self.weight * (s - s_a) } else { self.weight * (s - s_f).max(0.0) };
                let z = if s > s_a { rising.y } else { self.anchor_height + foot.y };
                (Vector3::new(place.x, z.max(0.0), 0.0), slope(horizontal, v))
            }
            Catenary::Piled => self.piled(s),
        }
    }

    /// Vertical legs, and between their feet an arc on the bed.
    fn piled(&self, s: f64) -> (Vector3<f64>, Vector3<f64>) {
        let leg = |height: f64| {
            let soft = self.ea / self.weight;
            2.0 * height / (1.0 + (1.0 + 2.0 * height / soft).sqrt())
        };
        let (leg_a, leg_f) = (leg(self.anchor_height), leg(self.fairlead_height));
        let on_bed = self.length - leg_a - leg_f;
        let s_f = self.length - leg_f;
        if s < leg_a {
            (Vector3::new(0.0, self.anchor_height * (1.0 - s / leg_a), 0.0), Vector3::new(0.0, -1.0, 0.0))
        } else if s > s_f {
            (Vector3::new(self.distance, self.fairlead_height * (s - s_f) / leg_f, 0.0), Vector3::new(0.0, 1.0, 0.0))
        } else {
            let half = half_angle(self.distance / on_bed.max(f64::MIN_POSITIVE));
            let angle = half * (2.0 * (s - leg_a) / on_bed - 1.0);
            let radius = 0.5 * on_bed / half;
            let place = Vector3::new(0.5 * self.distance + radius * angle.sin(), 0.0, radius * (angle.cos() - half.cos()));
            (place, Vector3::new(angle.cos(), 0.0, -angle.sin()))
        }
    }
}

/// Half opening angle of an arc whose chord is `ratio` times its length: sin(a)/a = ratio.
fn half_angle(ratio: f64) -> f64 {
    root::of_rising(1.0e-3, std::f64::consts::PI, |a| ratio - a.sin() / a)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Published closed forms with 12 digits (elastic, suspended and touching); the zeros are good to about 1e-12.
    #[test]
    fn horizontal_and_vertical_tension_agree_with_closed_forms() {
        let suspended =
            Span { distance: 400.0, anchor_height: 1e4, fairlead_height: 1e4 + 250.0, length: 500.0, weight: 700.0, ea: 3e7 };
        let Catenary::Hanging { horizontal, at_anchor } = suspended.solve() else { panic!() };
        assert!((horizontal / 187174.339285 - 1.0).abs() < 1e-9);
        assert!((at_anchor / -37478.714088 - 1.0).abs() < 1e-9);
        let touching =
            Span { distance: 1183.97, anchor_height: 0.0, fairlead_height: 120.0, length: 1200.0, weight: 1157.1590775, ea: 5e8 };
        let Catenary::Lying { horizontal, at_fairlead, .. } = touching.solve() else { panic!() };
        assert!((horizontal / 1193837.50353 - 1.0).abs() < 1e-9);
        assert!((at_fairlead / 591523.225065 - 1.0).abs() < 1e-9);
    }

    /// Every shape ends at the fairlead: to 1e-6 of the length, whatever the length, and nowhere below the bed.
    #[test]
    fn shapes_of_every_length_reach_the_fairlead() {
        for length in [130.0, 157.0, 170.0, 200.0, 219.0, 221.0, 300.0, 1000.0] {
            for distance in [0.0, 1.0, 100.0] {
                let span = Span { distance, anchor_height: 20.0, fairlead_height: 120.0, length, weight: 1000.0, ea: 1e8 };
                let shape = span.solve();
                let end = span.at(&shape, length).0;
                assert!((end - Vector3::new(distance, 120.0, 0.0)).norm() < 1e-4 * length, "{span:?} {shape:?} {end:?}");
                for k in 0..=100 {
                    assert!(span.at(&shape, length * k as f64 / 100.0).0.y > -1e-5, "{span:?} {shape:?}");
                }
            }
        }
    }
}
