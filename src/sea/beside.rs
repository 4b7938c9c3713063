//! The motion of a sea at points that a line keeps asking for, several side by side.

use crate::algebra::lanes::Lanes;
use crate::algebra::real::{MOST_LANES, Real, padded};
use crate::algebra::triple::Triple;
use crate::scene::types::Stretching;
use crate::sea::clock::Clock;
use crate::sea::columns::{Asked, Columns};
use crate::sea::waves::Waves;
use pulp::Simd;

/// With more directions of travel than these, points share what is kept instead.
const MOST_DIRECTIONS: usize = 4;
/// More components that are summed one by one are summed side by side rather than places.
const MOST_SINGLES: usize = 8;

/// Where and when points ask, side by side.
#[derive(Debug, Clone, Copy)]
pub struct Place<V: Simd> {
    /// When.
    pub clock: Clock,
    /// Where [m].
    pub at: Triple<Lanes<V>>,
}

impl<V: Simd> Place<V> {
    /// How far along a direction of travel [m].
    #[inline(always)]
    fn along(&self, [cos, sin]: [f64; 2]) -> Lanes<V> {
        self.at.x.scale_add(cos, self.at.y * sin)
    }
}

/// What points keep of every direction of travel.
#[derive(Debug, Clone)]
pub struct Beside {
    columns: Vec<Columns>,
}

impl Beside {
    /// Room for a number of points, and behind them for more of which the elevation alone is asked for; none where they had better ask for themselves.
    pub fn new(waves: &Waves, points: usize, more: usize) -> Option<Beside> {
        let directions = waves.directions();
        // Extrapolation asks for the slope at still water as well.
        let sloping = waves.stretching() == Stretching::Extrapolation && !directions.is_empty();
        if directions.len() > MOST_DIRECTIONS || waves.singles() > MOST_SINGLES || sloping {
            return None;
        }
        let [blocks, more] = [points, more].map(|count| padded(count) / MOST_LANES);
        Some(Beside { columns: directions.iter().map(|near| Columns::new(near, blocks, more)).collect() })
    }

    /// Elevation of the surface [m] at the points from `at` on, which are of one block; `wanted` is 1 where the answer is looked at, else 0.
    #[inline(always)]
    pub fn elevation<V: Simd>(&mut self, cpu: V, waves: &Waves, at: usize, place: &Place<V>, wanted: Lanes<V>) -> Lanes<V> {
        let easing = waves.easing(&place.clock).0;
        if easing == 0.0 {
            return Lanes::splat(cpu, 0.0);
        }
        self.surface(cpu, waves, at, place, wanted) * easing
    }

    /// The same before it is eased in.
    #[inline(always)]
    fn surface<V: Simd>(&mut self, cpu: V, waves: &Waves, at: usize, place: &Place<V>, wanted: Lanes<V>) -> Lanes<V> {
        let time = place.clock.now;
        let mut sum = Lanes::splat(cpu, 0.0);
        if waves.singles() > 0 {
            sum = waves.elevations::<Lanes<V>, true>(cpu, time, &place.at);
        }
        for (near, columns) in waves.directions().iter().zip(&mut self.columns) {
            let asked = Asked { at, time, along: place.along(near.direction()), wanted };
            sum = sum + columns.elevation(cpu, near, &asked);
        }
        sum
    }

    /// Velocities [m/s] and accelerations [m/s²] at the same points.
    #[inline(always)]
    pub fn motions<V: Simd>(&mut self, cpu: V, waves: &Waves, at: usize, place: &Place<V>, wanted: Lanes<V>) -> [Lanes<V>; 6] {
        let zero = Lanes::splat(cpu, 0.0);
        let mut rows = [zero; 6];
        let (easing, rise) = waves.easing(&place.clock);
        if easing != 0.0 {
            let time = place.clock.now;
            let elevation =
                if self.columns.is_empty() { None } else { Some(self.surface(cpu, waves, at, place, wanted) * easing) };
            let (mut v, mut dv) = ([zero; 3], [zero; 3]);
            if waves.singles() > 0 {
                (v, dv) = waves.sums::<Lanes<V>, true>(cpu, time, easing, &place.at, elevation);
            }
            if let Some(elevation) = elevation {
                let level = waves.stretching().level(cpu, place.at.z, elevation, waves.depth());
                for (near, columns) in waves.directions().iter().zip(&mut self.columns) {
                    let [cos, sin] = near.direction();
                    let asked = Asked { at, time, along: place.along([cos, sin]), wanted };
                    let [u, w, du, dw] = columns.motion(cpu, near, &asked, level.z);
                    let (u, w, du, dw) = (u * level.share, w * level.share, du * level.share, dw * level.share);
                    v = [u.scale_add(cos, v[0]), u.scale_add(sin, v[1]), v[2] + w];
                    dv = [du.scale_add(cos, dv[0]), du.scale_add(sin, dv[1]), dv[2] + dw];
                }
            }
            let mut c = 0;
            while c < 3 {
                rows[c] = v[c] * easing;
                rows[3 + c] = dv[c].scale_add(easing, v[c] * rise);
                c += 1;
            }
        }
        if let Some(stream) = waves.stream_at(V::F64_LANES, &place.clock, place.at.z.lanes()) {
            rows.iter_mut().zip(&stream).for_each(|(row, stream)| *row = *row + Lanes::load(cpu, stream, 0));
        }
        rows
    }
}
