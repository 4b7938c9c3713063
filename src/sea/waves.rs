//! Waves: a sum of components by linear theory in finite depth, stretched to the surface (`stretching`).
//!
//! ```text
//! η = S Σ a cos θ,   θ = k (x cos b + y sin b) - ω t + φ,   ω² = g k tanh kd
//! v = S Σ a ω [C cos θ cos b, C cos θ sin b, D sin θ],   C = cosh k(z′+d) / sinh kd,   D = sinh k(z′+d) / sinh kd
//! z′ + d = (z + d) d / (d + η)                                                                  (Wheeler 1970; others in `stretching`)
//! ```
//!
//! η elevation [m], v velocity [m/s], d depth [m], S = ξ²(3 - 2ξ), ξ = (t - start)/ramp: the amplitude is eased in. The acceleration is
//! the local one, ∂v/∂t at constant z′, which is linear theory. Above the surface the motion is that of the surface. Every direction b is
//! the one of travel.
//!
//! A component is left out where it has decayed to less than 1e-4 of its motion at the surface, counted from a trough as deep as the
//! significant wave height; what lies deeper than the longest component reaches is not looked at. Sine, cosine and exponential are polynomials, good to 3e-11,
//! because they then run on several numbers at once: on several places for the element loop, on several components for a single place.
//! Where there are many components of one direction, `near` takes their sums by cells of space and time, each direction for itself.

use crate::algebra::lanes::Lanes;
use crate::algebra::real::Across;
use crate::algebra::real::{MOST_LANES, Real, padded};
use crate::algebra::shape::Shape;
use crate::algebra::stokes::{ORDER, Stokes};
use crate::algebra::triple::Triple;
use crate::scene::types::{Environment, Stretching};
use crate::sea::clock::Clock;
use crate::sea::drawing::{self, Drawn};
use crate::sea::layer::{Member, Water};
use crate::sea::near::Near;
use crate::sea::series::{DECAYED, cos_sin, decay};
use crate::sea::stream::Stream;
use crate::sea::stretching::Level;
use crate::sea::wave::{Wave, wave_number};
use nalgebra::Vector3;
use pulp::{Arch, Simd, WithSimd};
use std::f64::consts::TAU;
use std::sync::Arc;

/// Motion of the water.
#[derive(Debug, Clone, Copy)]
pub struct Flow<F: Real> {
    /// v [m/s].
    pub velocity: Triple<F>,
    /// ∂v/∂t [m/s²].
    pub acceleration: Triple<F>,
}

/// A sea: its components in rows, longest wave first, padded.
#[derive(Debug, Clone)]
pub struct Waves {
    waves: Vec<Wave>,
    /// Components that are summed one by one.
    count: usize,
    rows: [Vec<f64>; ROWS],
    /// Components that are summed by cells, one direction each.
    near: Vec<Near>,
    /// The current that they run on, where it changes in time.
    stream: Option<Arc<Stream>>,
    stretching: Stretching,
    /// The motion holds up to the crest as it stands, without stretching.
    whole: bool,
    mean: (f64, f64),
    depth: f64,
    gravity: f64,
    ramp: f64,
    crest: f64,
    height: f64,
    longest: f64,
    processor: Arch,
}

/// A number of a component. Angles are in turns, so that they are reduced by rounding.
#[derive(Debug, Clone, Copy)]
enum Row {
    /// k cos b / 2π [1/m].
    X,
    /// k sin b / 2π [1/m].
    Y,
    /// ω / 2π [1/s].
    Frequency,
    /// φ / 2π [-].
    Phase,
    /// k [1/m].
    Number,
    Amplitude,
    /// cos b.
    Cos,
    /// sin b.
    Sin,
    /// a ω / (1 - e^(-2kd)) [m/s].
    Speed,
    /// a ω² / (1 - e^(-2kd)) [m/s²].
    Rate,
    /// e^(-2kd), what the bed sends back; 0 in deep water.
    Echo,
}

const ROWS: usize = Row::Echo as usize + 1;

/// Components are left out where less than this share of their motion at the surface is left.
const FAINT: f64 = 1.0e-4;
/// No more directions than this are tried for cells.
const MOST_DIRECTIONS: usize = 1000;
/// A random sea's crests are counted on up to this many standard deviations; one higher is rarer than one in 10²¹ waves.
const RARE: f64 = 10.0;

impl Waves {
    /// The waves of an environment, and the current that they run on where it changes in time.
    pub fn of(environment: &Environment) -> Option<Waves> {
        let rows = environment.current_over_time.as_ref().and_then(|current| current.rows.as_deref());
        let Some(stream) = rows.and_then(Stream::new) else { return Waves::of_seas(environment) };
        let calm = || Waves::new(&[], environment.gravity, environment.depth, 0.0);
        Some(Waves { stream: Some(Arc::new(stream)), ..Waves::of_seas(environment).unwrap_or_else(calm) })
    }

    fn of_seas(environment: &Environment) -> Option<Waves> {
        let seas = environment.waves.as_ref()?;
        let drawn: Vec<Drawn> =
            drawing::seas(environment).into_iter().filter(|sea| !sea.waves.is_empty() || sea.steady.is_some()).collect();
        let ramp = drawn.iter().map(|sea| sea.ramp).fold(0.0, f64::max);
        if let Some((stokes, angles)) = drawn.iter().find_map(|sea| sea.steady.as_ref()) {
            return Some(Waves::steady(stokes, *angles, environment.gravity, environment.depth, ramp));
        }
        let crest = drawn.iter().map(|sea| {
            let all = sea.waves.iter().map(|wave| wave.amplitude).sum::<f64>();
            if sea.random { all.min(RARE * deviation(&sea.waves)) } else { all }
        });
        let crest = crest.sum();
        let waves: Vec<Wave> = drawn.into_iter().flat_map(|sea| sea.waves).collect();
        if !(crest > 0.0) {
            return None;
        }
        let mut sea = Waves::new(&waves, environment.gravity, environment.depth, ramp).stretched(seas.stretching());
        sea.crest = crest;
        Some(sea)
    }

    /// A sea of components in water of a depth [m], eased in over `ramp` [s], with Wheeler's stretching.
    pub fn new(waves: &[Wave], gravity: f64, depth: f64, ramp: f64) -> Waves {
        Waves::summed(waves.to_vec(), gravity, depth, ramp, Stretching::Wheeler, true)
    }

    /// A steady wave of the fifth order, of a direction and a phase [rad]: its harmonics are bound, and hold up to the crest as they stand.
    pub fn steady(wave: &Stokes, [direction, phase]: [f64; 2], gravity: f64, depth: f64, ramp: f64) -> Waves {
        let mut sea = Waves::summed(Vec::new(), gravity, depth, ramp, Stretching::Wheeler, false);
        sea.rows = std::array::from_fn(|_| vec![0.0; padded(ORDER) + MOST_LANES]);
        for n in 0..ORDER {
            let harmonic = (n + 1) as f64;
            let of = Wave { amplitude: wave.elevations[n], omega: harmonic * wave.omega, direction, phase: harmonic * phase };
            let numbers = of.moving_at(harmonic * wave.number, wave.speeds[n], depth);
            sea.rows.iter_mut().zip(numbers).for_each(|(row, number)| row[n] = number);
        }
        sea.crest = wave.elevations.iter().map(|elevation| elevation.abs()).sum();
        (sea.count, sea.whole, sea.height, sea.longest) = (ORDER, true, 2.0 * sea.crest, wave.number);
        sea.mean = (wave.omega, wave.number);
        sea
    }

    /// The same sea, carried to the surface in another way.
    pub fn stretched(self, stretching: Stretching) -> Waves {
        if stretching == self.stretching {
            return self;
        }
        let Waves { crest, gravity, depth, ramp, stream, .. } = self;
        Waves { crest, stream, ..Waves::summed(self.waves, gravity, depth, ramp, stretching, true) }
    }

    /// The same sea with its components summed one by one everywhere: what sums by cells are judged by.
    pub fn one_by_one(self) -> Waves {
        let Waves { crest, gravity, depth, ramp, stretching, stream, .. } = self;
        Waves { crest, stream, ..Waves::summed(self.waves, gravity, depth, ramp, stretching, false) }
    }

    /// A sea whose directions are summed by cells, each where it has enough components and cells are allowed.
    fn summed(waves: Vec<Wave>, gravity: f64, depth: f64, ramp: f64, stretching: Stretching, cells: bool) -> Waves {
        let mut numbered: Vec<(f64, &Wave)> = waves.iter().map(|wave| (wave_number(wave.omega, gravity, depth), wave)).collect();
        numbered.sort_by(|one, other| one.0.total_cmp(&other.0));
        let crest = waves.iter().map(|wave| wave.amplitude).sum::<f64>();
        let height = crest.min(4.0 * deviation(&waves));
        let longest = numbered.first().map_or(f64::INFINITY, |(k, _)| *k);
        let all = rows_of(&numbered, depth);
        let mean = mean(&all, numbered.len(), gravity, depth);
        let mut near = Vec::new();
        if cells {
            let mut directions: Vec<f64> = Vec::new();
            numbered.iter().filter(|(_, wave)| wave.amplitude > 0.0).for_each(|(_, wave)| {
                if !directions.contains(&wave.direction) && directions.len() <= MOST_DIRECTIONS {
                    directions.push(wave.direction);
                }
            });
            for direction in directions {
                let own: Vec<(f64, &Wave)> = numbered.iter().filter(|(_, wave)| wave.direction == direction).copied().collect();
                let members = members(&rows_of(&own, depth), own.len());
                if let Some(by_cells) = Near::new(&members, Water { gravity, depth, height, direction, stretching }) {
                    near.push(by_cells);
                    numbered.retain(|(_, wave)| wave.direction != direction);
                }
            }
        }
        let (count, rows) = (numbered.len(), rows_of(&numbered, depth));
        Waves {
            count,
            rows,
            near,
            stream: None,
            stretching,
            whole: false,
            mean,
            depth,
            gravity,
            ramp,
            crest,
            height,
            longest,
            waves,
            processor: Arch::new(),
        }
    }

    /// Whether all components are summed by cells rather than one by one.
    pub fn by_cells(&self) -> bool {
        self.count == 0
    }

    /// Number of components.
    pub fn components(&self) -> usize {
        if self.whole { self.count } else { self.waves.len() }
    }

    /// The mean frequency √(m₂/m₀) of the waves by energy [rad/s], and the wave number that goes with it [1/m].
    pub fn mean(&self) -> (f64, f64) {
        self.mean
    }

    /// Height above and depth below still water that the surface never passes [m]: all crests together; in a random sea, `RARE` standard
    /// deviations if that is less.
    pub fn crest(&self) -> f64 {
        self.crest
    }

    /// Height z below which the water is taken to be at rest [m].
    pub fn floor(&self) -> f64 {
        -self.height + FAINT.ln() / self.longest
    }

    /// g [m/s²].
    pub fn gravity(&self) -> f64 {
        self.gravity
    }

    /// The directions of travel of which components are summed by cells.
    pub fn directions(&self) -> &[Near] {
        &self.near
    }

    /// How many components are summed one by one.
    pub fn singles(&self) -> usize {
        self.count
    }

    /// How motions are carried to the surface.
    pub fn stretching(&self) -> Stretching {
        self.stretching
    }

    /// d [m].
    pub fn depth(&self) -> f64 {
        self.depth
    }

    /// S and dS/dt [1/s].
    pub fn easing(&self, clock: &Clock) -> (f64, f64) {
        let elapsed = clock.now - clock.start;
        if elapsed <= 0.0 {
            (0.0, 0.0)
        } else if elapsed >= self.ramp {
            (1.0, 0.0)
        } else {
            let shape = Shape::at(elapsed / self.ramp);
            (shape.value[2], shape.slope[2] / self.ramp)
        }
    }

    /// η at a place [m].
    pub fn elevation(&self, clock: &Clock, x: f64, y: f64) -> f64 {
        let easing = self.easing(clock).0;
        if easing == 0.0 {
            return 0.0;
        }
        self.surface(clock.now, x, y) * easing
    }

    /// η at a place before it is eased in [m].
    fn surface(&self, time: f64, x: f64, y: f64) -> f64 {
        let one_by_one = || self.processor.dispatch(Elevation { waves: self, time, x, y });
        match &self.near[..] {
            [] => one_by_one(),
            [near] if self.count == 0 => near.elevation(time, x, y),
            several => {
                let by_cells = several.iter().map(|near| near.elevation(time, x, y)).sum::<f64>();
                if self.count == 0 { by_cells } else { by_cells + one_by_one() }
            }
        }
    }

    /// The motion of the water at places, or none where it is at rest. One place alone is better asked for with `f64`.
    #[inline(always)]
    pub fn flow<F: Real>(&self, cpu: F::Cpu, clock: &Clock, place: &Triple<F>) -> Option<Flow<F>> {
        let waves = self.flow_of_waves(cpu, clock, place);
        let Some([vx, vy, vz, ax, ay, az]) = &self.stream_at(F::LANES, clock, place.z.lanes()) else { return waves };
        let (velocity, acceleration) = (Triple::load(cpu, [vx, vy, vz], 0), Triple::load(cpu, [ax, ay, az], 0));
        Some(match waves {
            Some(flow) => Flow { velocity: velocity + flow.velocity, acceleration: acceleration + flow.acceleration },
            None => Flow { velocity, acceleration },
        })
    }

    /// Velocities [m/s] and accelerations [m/s²] at `count` places (rows x, y, z [m]; what lies beyond them repeats one).
    pub fn motions(&self, clock: &Clock, count: usize, places: &[[f64; MOST_LANES]; 3]) -> [[f64; MOST_LANES]; 6] {
        let mut rows = [[0.0; MOST_LANES]; 6];
        let (easing, rise) = self.easing(clock);
        if easing != 0.0 {
            rows = self.sums_at(count, clock.now, easing, *places);
            for c in 0..3 {
                for lane in 0..MOST_LANES {
                    rows[3 + c][lane] = rows[c][lane] * rise + rows[3 + c][lane] * easing;
                    rows[c][lane] *= easing;
                }
            }
        }
        if let Some(stream) = self.stream_at(count, clock, places[2]) {
            for (row, stream) in rows.iter_mut().zip(stream) {
                row.iter_mut().zip(stream).for_each(|(sum, number)| *sum += number);
            }
        }
        rows
    }

    /// Height z below which nothing moves: `floor`, unless there is a current that changes in time.
    pub fn lowest_motion(&self) -> f64 {
        if self.stream.is_some() { f64::NEG_INFINITY } else { self.floor() }
    }

    /// Velocities [m/s] and accelerations [m/s²] of the current that changes in time at `count` heights [m]; none without such a current.
    #[inline]
    pub fn stream_at(&self, count: usize, clock: &Clock, heights: [f64; MOST_LANES]) -> Option<[[f64; MOST_LANES]; 6]> {
        Some(streams_at(self.stream.as_ref()?, count, clock, heights))
    }

    #[inline(always)]
    fn flow_of_waves<F: Real>(&self, cpu: F::Cpu, clock: &Clock, place: &Triple<F>) -> Option<Flow<F>> {
        let (easing, rise) = self.easing(clock);
        if easing == 0.0 || !(place.z + -self.floor()).any_positive() {
            return None;
        }
        let rows = self.sums_at(F::LANES, clock.now, easing, [place.x.lanes(), place.y.value(cpu).lanes(), place.z.lanes()]);
        let [vx, vy, vz, ax, ay, az] = &rows;
        let (v, a) = (Triple::load(cpu, [vx, vy, vz], 0), Triple::load(cpu, [ax, ay, az], 0));
        Some(Flow { velocity: v.scale(easing), acceleration: v.scale_add(rise, a.scale(easing)) })
    }

    /// Sums of the velocities and accelerations at `count` places. On its own, so that it is not compiled into every loop over
    /// elements.
    #[inline(never)]
    fn sums_at(&self, count: usize, time: f64, easing: f64, places: [[f64; MOST_LANES]; 3]) -> [[f64; MOST_LANES]; 6] {
        match &self.near[..] {
            [] => self.processor.dispatch(Sums { waves: self, count, time, easing, places, elevations: None }),
            [near] if self.count == 0 => near.sums(count, time, easing, &places),
            several => self.sums_of_directions(several, count, time, easing, &places),
        }
    }

    /// The same where there are directions that are summed by cells, and others: they share the surface that all of them make.
    fn sums_of_directions(
        &self,
        directions: &[Near],
        count: usize,
        time: f64,
        easing: f64,
        places: &[[f64; MOST_LANES]; 3],
    ) -> [[f64; MOST_LANES]; 6] {
        let mut elevations = [0.0; MOST_LANES];
        for lane in 0..count {
            let [x, y, _] = places.map(|row| row[lane]);
            elevations[lane] = easing * self.surface(time, x, y);
        }
        let mut sums = [[0.0; MOST_LANES]; 6];
        if self.count > 0 {
            let elevations = Some(elevations);
            sums = self.processor.dispatch(Sums { waves: self, count, time, easing, places: *places, elevations });
        }
        let levels: [Level<f64>; MOST_LANES] =
            std::array::from_fn(|lane| self.stretching.level((), places[2][lane], elevations[lane], self.depth));
        for near in directions {
            near.add_motions(time, places, &levels[..count], &mut sums);
        }
        sums
    }

    /// Sums of the velocities and accelerations of the components that are summed one by one, before they are eased in. `PLACES`: the lanes hold
    /// several places, else several components. `elevation`: that of all components, where it is known.
    #[inline(always)]
    pub fn sums<F: Real, const PLACES: bool>(
        &self,
        cpu: F::Cpu,
        time: f64,
        easing: f64,
        place: &Triple<F>,
        elevation: Option<F>,
    ) -> ([F; 3], [F; 3]) {
        let zero = F::splat(cpu, 0.0);
        // A wave that is alone turns by one angle.
        let alone = if PLACES && self.count == 1 { Some(self.angle::<F, PLACES>(cpu, time, place, 0)) } else { None };
        let elevation = match (elevation, &alone) {
            (Some(elevation), _) => elevation,
            (None, Some((cos, _))) => self.get::<F, PLACES>(cpu, Row::Amplitude, 0) * *cos * easing,
            (None, None) => self.elevations::<F, PLACES>(cpu, time, place) * easing,
        };
        let level = if self.whole {
            let z = place.z.min(elevation).max(F::splat(cpu, -self.depth));
            Level { z, above: zero, share: zero }
        } else {
            self.stretching.level(cpu, place.z, elevation, self.depth)
        };
        let Level { z, above, share } = level;
        let carried = above.any_positive();
        let [mut vx, mut vy, mut vz, mut ax, mut ay, mut az] = [zero; 6];
        for n in (0..self.reaching(place.z.highest())).step_by(if PLACES { 1 } else { F::LANES }) {
            let (cos, sin) = match alone {
                Some(angle) => angle,
                None => self.angle::<F, PLACES>(cpu, time, place, n),
            };
            let down = decay(cpu, self.get::<F, PLACES>(cpu, Row::Number, n) * z);
            let echo = self.get::<F, PLACES>(cpu, Row::Echo, n);
            let back = if echo.any_positive() { echo * down.reciprocal() } else { zero };
            let (mut level, mut upright) = (down + back, down - back);
            if carried {
                let above = self.get::<F, PLACES>(cpu, Row::Number, n) * above;
                (level, upright) = (upright.mul_add(above, level), level.mul_add(above, upright));
            }
            let (speed, rate) = (self.get::<F, PLACES>(cpu, Row::Speed, n), self.get::<F, PLACES>(cpu, Row::Rate, n));
            let (v, a) = (level * cos * speed, level * sin * rate);
            let (cos_b, sin_b) = (self.get::<F, PLACES>(cpu, Row::Cos, n), self.get::<F, PLACES>(cpu, Row::Sin, n));
            (vx, vy, vz) = (v.mul_add(cos_b, vx), v.mul_add(sin_b, vy), (upright * sin).mul_add(speed, vz));
            (ax, ay, az) = (a.mul_add(cos_b, ax), a.mul_add(sin_b, ay), (upright * cos).mul_add(-rate, az));
        }
        if !PLACES {
            [vx, vy, vz, ax, ay, az] = [vx, vy, vz, ax, ay, az].map(|sum| F::splat(cpu, sum.total()));
        }
        if self.stretching == Stretching::None {
            (vx, vy, vz, ax, ay, az) = (vx * share, vy * share, vz * share, ax * share, ay * share, az * share);
        }
        ([vx, vy, vz], [ax, ay, az])
    }

    /// Σ a cos θ of the components that are summed one by one [m].
    #[inline(always)]
    pub fn elevations<F: Real, const PLACES: bool>(&self, cpu: F::Cpu, time: f64, place: &Triple<F>) -> F {
        let mut sum = F::splat(cpu, 0.0);
        for n in (0..self.count).step_by(if PLACES { 1 } else { F::LANES }) {
            let (cos, _) = self.angle::<F, PLACES>(cpu, time, place, n);
            sum = self.get::<F, PLACES>(cpu, Row::Amplitude, n).mul_add(cos, sum);
        }
        if PLACES { sum } else { F::splat(cpu, sum.total()) }
    }

    /// cos θ and sin θ.
    #[inline(always)]
    fn angle<F: Real, const PLACES: bool>(&self, cpu: F::Cpu, time: f64, place: &Triple<F>, n: usize) -> (F, F) {
        let still = self.get::<F, PLACES>(cpu, Row::Frequency, n).scale_add(-time, self.get::<F, PLACES>(cpu, Row::Phase, n));
        let across = self.get::<F, PLACES>(cpu, Row::Y, n).mul_add(place.y.value(cpu), still);
        cos_sin(cpu, self.get::<F, PLACES>(cpu, Row::X, n).mul_add(place.x, across))
    }

    #[inline(always)]
    fn get<F: Real, const PLACES: bool>(&self, cpu: F::Cpu, row: Row, n: usize) -> F {
        let row = &self.rows[row as usize];
        if PLACES { F::splat(cpu, row[n]) } else { F::load(cpu, row, n) }
    }

    /// How many components reach down to z.
    fn reaching(&self, z: f64) -> usize {
        let below = -z - self.height;
        if below <= 0.0 {
            return self.count;
        }
        self.rows[Row::Number as usize][..self.count].partition_point(|k| k * below < -FAINT.ln())
    }
}

#[inline(never)]
fn streams_at(stream: &Stream, count: usize, clock: &Clock, heights: [f64; MOST_LANES]) -> [[f64; MOST_LANES]; 6] {
    let mut rows = [[0.0; MOST_LANES]; 6];
    // At rest the current is that of the start, as if it had always been.
    let moving = if clock.now > clock.start { 1.0 } else { 0.0 };
    for (lane, z) in heights.into_iter().enumerate().take(count) {
        let (v, a): (Triple<f64>, Triple<f64>) = stream.flow((), clock.now, z);
        let a = a * moving;
        rows.iter_mut().zip([v.x, v.y, v.z, a.x, a.y, a.z]).for_each(|(row, number)| row[lane] = number);
    }
    rows
}

/// Components with their wave numbers in rows, padded.
fn rows_of(numbered: &[(f64, &Wave)], depth: f64) -> [Vec<f64>; ROWS] {
    let mut rows: [Vec<f64>; ROWS] = std::array::from_fn(|_| vec![0.0; padded(numbered.len()) + MOST_LANES]);
    for (n, (k, wave)) in numbered.iter().enumerate() {
        rows.iter_mut().zip(wave.numbers(*k, depth)).for_each(|(row, number)| row[n] = number);
    }
    rows
}

fn members(rows: &[Vec<f64>; ROWS], count: usize) -> Vec<Member> {
    let get = |row: Row, n: usize| rows[row as usize][n];
    let member = |n: usize| Member {
        number: get(Row::Number, n),
        omega: TAU * get(Row::Frequency, n),
        phase: TAU * get(Row::Phase, n),
        amplitude: get(Row::Amplitude, n),
        speed: get(Row::Speed, n),
        echoes: get(Row::Echo, n) > 0.0,
    };
    (0..count).map(member).collect()
}

/// `Waves::mean` of components in rows.
fn mean(rows: &[Vec<f64>; ROWS], count: usize, gravity: f64, depth: f64) -> (f64, f64) {
    let [frequency, amplitude] = [Row::Frequency, Row::Amplitude].map(|row| &rows[row as usize][..count]);
    let moment = |n: i32| frequency.iter().zip(amplitude).map(|(f, a)| a * a * f.powi(n)).sum::<f64>();
    let omega = TAU * (moment(2) / moment(0)).sqrt();
    (omega, wave_number(omega, gravity, depth))
}

/// Standard deviation of the elevation [m].
fn deviation(waves: &[Wave]) -> f64 {
    waves.iter().map(|wave| 0.5 * wave.amplitude * wave.amplitude).sum::<f64>().sqrt()
}

impl Wave {
    /// The row entries of a wave of number k [1/m].
    fn numbers(&self, k: f64, depth: f64) -> [f64; ROWS] {
        self.moving_at(k, self.amplitude * self.omega, depth)
    }

    /// The same of a wave whose upright speed at still water is given [m/s].
    fn moving_at(&self, k: f64, speed: f64, depth: f64) -> [f64; ROWS] {
        let (sin, cos) = self.direction.sin_cos();
        let echo = if k * depth < DECAYED { (-2.0 * k * depth).exp() } else { 0.0 };
        let speed = speed / if echo > 0.0 { -(-2.0 * k * depth).exp_m1() } else { 1.0 };
        let turn = 1.0 / TAU;
        [
            k * cos * turn,
            k * sin * turn,
            self.omega * turn,
            self.phase * turn,
            k,
            self.amplitude,
            cos,
            sin,
            speed,
            speed * self.omega,
            echo,
        ]
    }
}

/// `Waves::sums` at several places side by side, or at one with several components side by side.
struct Sums<'a> {
    waves: &'a Waves,
    count: usize,
    time: f64,
    easing: f64,
    places: [[f64; MOST_LANES]; 3],
    /// η of all components, eased in, where it is known already.
    elevations: Option<[f64; MOST_LANES]>,
}

impl WithSimd for Sums<'_> {
    type Output = [[f64; MOST_LANES]; 6];

    #[inline(always)]
    fn with_simd<V: Simd>(self, cpu: V) -> Self::Output {
        let Sums { waves, count, time, easing, places: [x, y, z], elevations } = &self;
        let mut rows = [[0.0; MOST_LANES]; 6];
        let mut at = 0;
        while at < *count {
            let (v, a) = if *count > 1 {
                let place = Triple::load(cpu, [x, y, z], at);
                let elevation = elevations.as_ref().map(|row| Lanes::<V>::load(cpu, row, at));
                waves.sums::<Lanes<V>, true>(cpu, *time, *easing, &place, elevation)
            } else {
                let place = Triple::splat(cpu, &Vector3::new(x[0], y[0], z[0]));
                let elevation = elevations.map(|row| Lanes::<V>::splat(cpu, row[0]));
                waves.sums::<Lanes<V>, false>(cpu, *time, *easing, &place, elevation)
            };
            for (row, sum) in rows.iter_mut().zip([v[0], v[1], v[2], a[0], a[1], a[2]]) {
                sum.store(row, at);
            }
            at += V::F64_LANES;
        }
        rows
    }
}

/// `Waves::elevations` at one place.
struct Elevation<'a> {
    waves: &'a Waves,
    time: f64,
    x: f64,
    y: f64,
}

impl WithSimd for Elevation<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<V: Simd>(self, cpu: V) -> f64 {
        let place = Triple::splat(cpu, &Vector3::new(self.x, self.y, 0.0));
        self.waves.elevations::<Lanes<V>, false>(cpu, self.time, &place).first()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sea::spectrum::Jonswap;

    const G: f64 = 9.80665;

    fn place(x: f64, y: f64, z: f64) -> Triple<f64> {
        Triple { x, y, z }
    }

    fn late(now: f64) -> Clock {
        Clock { now, start: -1.0e4 }
    }

    /// A sea of waves long and short, in all directions.
    fn cross_sea(count: usize) -> Vec<Wave> {
        let wave = |n: usize| {
            let n = n as f64;
            Wave { amplitude: 0.2 + 0.01 * n, omega: 0.35 + 0.11 * n, direction: 0.7 * n, phase: 1.3 * n }
        };
        (0..count).map(wave).collect()
    }

    /// η, v and ∂v/∂t by the formulas on top, with the functions of the standard library.
    fn exact(waves: &[Wave], depth: f64, time: f64, at: &Triple<f64>) -> (f64, [f64; 3], [f64; 3]) {
        let numbered: Vec<(f64, f64, &Wave)> = waves
            .iter()
            .map(|wave| {
                let k = wave_number(wave.omega, G, depth);
                let along = at.x * wave.direction.cos() + at.y * wave.direction.sin();
                (k, k * along - wave.omega * time + wave.phase, wave)
            })
            .collect();
        let elevation: f64 = numbered.iter().map(|(_, angle, wave)| wave.amplitude * angle.cos()).sum();
        let above_bed = (at.z.min(elevation) + depth) * depth / (depth + elevation);
        let (mut v, mut a) = ([0.0; 3], [0.0; 3]);
        for (k, angle, wave) in numbered {
            let speed = wave.amplitude * wave.omega / (k * depth).sinh();
            let (level, upright) = (speed * (k * above_bed).cosh(), speed * (k * above_bed).sinh());
            let (sin_b, cos_b) = wave.direction.sin_cos();
            let (sin, cos) = angle.sin_cos();
            for (c, (v_c, a_c)) in [(cos * cos_b, sin * cos_b), (cos * sin_b, sin * sin_b), (sin, -cos)].into_iter().enumerate() {
                let height = if c < 2 { level } else { upright };
                v[c] += height * v_c;
                a[c] += height * wave.omega * a_c;
            }
        }
        (elevation, v, a)
    }

    /// ω² = g k tanh kd to 1e-10 (measured: rounding), and both limits: k = ω²/g in deep, ω/√(gd) in shallow water.
    #[test]
    fn the_wave_number_meets_the_dispersion_relation() {
        for depth in [1.0, 20.0, 120.0, 3000.0] {
            for n in 0..400 {
                let omega = 0.01 * 1.02f64.powi(n);
                let k = wave_number(omega, G, depth);
                let squared = G * k * (k * depth).tanh();
                assert!((squared / (omega * omega) - 1.0).abs() < 1e-12, "ω = {omega}, d = {depth}: k = {k}");
            }
        }
        assert!((wave_number(2.0, G, 500.0) / (4.0 / G) - 1.0).abs() < 1e-14);
        let (omega, depth) = (1e-3, 10.0);
        let long = omega / (G * depth).sqrt();
        // The next term of the series of tanh: k = k0 (1 + (k0 d)²/6).
        assert!((wave_number(omega, G, depth) / long - 1.0 - (long * depth).powi(2) / 6.0).abs() < 1e-11);
    }

    /// Elevation and motion against the formulas with cosh and sinh, at depths from deep to shallow, by both paths through the components
    /// (one and many), at, below and above the surface. 1e-9 of the largest is what the series are good for times the
    /// number of components.
    #[test]
    fn elevation_and_motion_are_those_of_linear_theory() {
        for (depth, count) in [(200.0, 1), (200.0, 30), (40.0, 30), (12.0, 5)] {
            let waves = cross_sea(count);
            let sea = Waves::new(&waves, G, depth, 0.0);
            for (x, y, z, time) in
                [(0.0, 0.0, 0.0, 0.0), (13.0, -70.0, -3.0, 5.3), (-1e3, 500.0, -8.0, 1e3), (4.0, 2.0, 30.0, 77.7)]
            {
                let at = place(x, y, z);
                let (elevation, v, a) = exact(&waves, depth, time, &at);
                assert!((sea.elevation(&late(time), x, y) - elevation).abs() < 1e-9, "η");
                let flow = sea.flow((), &late(time), &at).expect("in motion");
                for c in 0..3 {
                    let (found_v, found_a) = (flow.velocity.components(())[c], flow.acceleration.components(())[c]);
                    assert!((found_v - v[c]).abs() < 1e-8, "v{c} at {at:?}, t = {time}: {found_v} {}", v[c]);
                    assert!((found_a - a[c]).abs() < 1e-8, "a{c} at {at:?}, t = {time}: {found_a} {}", a[c]);
                }
                // Places side by side.
                let (v, a) = sea.sums::<f64, true>((), time, 1.0, &at, None);
                let (_, exact_v, exact_a) = exact(&waves, depth, time, &at);
                for c in 0..3 {
                    assert!((v[c] - exact_v[c]).abs() < 1e-8 && (a[c] - exact_a[c]).abs() < 1e-8);
                }
            }
        }
    }

    /// At the surface, wherever it is, the motion is that of linear theory at z = 0; at the bed nothing moves up or down.
    #[test]
    fn stretching_puts_the_motion_of_still_water_level_at_the_surface() {
        let (depth, wave) = (30.0, Wave { amplitude: 3.0, omega: 0.8, direction: 0.4, phase: 0.0 });
        let sea = Waves::new(&[wave], G, depth, 0.0);
        let k = wave_number(wave.omega, G, depth);
        for time in [0.0, 1.0, 2.5, 4.0] {
            let elevation = sea.elevation(&late(time), 0.0, 0.0);
            let angle = -wave.omega * time;
            let speed = wave.amplitude * wave.omega;
            let flow = sea.flow((), &late(time), &place(0.0, 0.0, elevation)).expect("in motion");
            let level = speed / (k * depth).tanh() * angle.cos();
            assert!((flow.velocity.x - level * wave.direction.cos()).abs() < 1e-9);
            assert!((flow.velocity.y - level * wave.direction.sin()).abs() < 1e-9);
            assert!((flow.velocity.z - speed * angle.sin()).abs() < 1e-9);
            let bed = sea.flow((), &late(time), &place(0.0, 0.0, -depth)).expect("in motion");
            assert!(bed.velocity.z.abs() < 1e-9 && bed.acceleration.z.abs() < 1e-9);
        }
    }

    /// While the sea rises, the acceleration is the change of the velocity (central difference, 1e-4 s; the wave is so low
    /// that the moving surface does not matter); before the start it is calm.
    #[test]
    fn the_sea_is_eased_in() {
        let wave = Wave { amplitude: 1e-6, omega: 0.9, direction: 0.0, phase: 0.3 };
        let sea = Waves::new(&[wave], G, 300.0, 12.0);
        let at = place(5.0, 0.0, -4.0);
        let flow = |now: f64| sea.flow((), &Clock { now, start: 100.0 }, &at);
        assert!(flow(100.0).is_none() && flow(20.0).is_none());
        assert_eq!(sea.elevation(&Clock::at_rest(100.0), 0.0, 0.0), 0.0);
        for now in [101.0, 106.0, 111.5, 140.0] {
            let d = 1e-4;
            let (before, here, after) = (flow(now - d), flow(now), flow(now + d));
            let (Some(before), Some(here), Some(after)) = (before, here, after) else { panic!("calm at {now}") };
            let change = (after.velocity - before.velocity) * (0.5 / d);
            assert!((change - here.acceleration).dot(change - here.acceleration).sqrt() < 1e-5 * wave.amplitude, "{now}");
        }
    }

    /// What is left out at depth is less than 1e-4 of the motion of each component at the surface, 2e-4 of it at the bed, which doubles it.
    #[test]
    fn what_is_left_out_is_faint() {
        let waves = cross_sea(40);
        let depth = 150.0;
        let sea = Waves::new(&waves, G, depth, 0.0);
        let surface: f64 = waves.iter().map(|wave| wave.amplitude * wave.omega).sum();
        for z in [-20.0, -40.0, -60.0, -90.0, -140.0, -149.0] {
            let at = place(30.0, -10.0, z);
            let (_, v, _) = exact(&waves, depth, 33.0, &at);
            let found = sea.flow((), &late(33.0), &at).map_or([0.0; 3], |flow| flow.velocity.components(()));
            for c in 0..3 {
                assert!((found[c] - v[c]).abs() < 2e-4 * surface, "z = {z}: {found:?} {v:?}");
            }
        }
        assert!(sea.reaching(-60.0) < 40 && sea.reaching(0.0) == 40);
        assert_eq!(sea.reaching(sea.floor() - 1e-6), 0);
    }

    /// The variance of the elevation of a random sea over six hours: H_s²/16 within 1 %. The time average of the products of 200 components
    /// at random frequencies is good for 0.5 % in this time.
    #[test]
    fn the_variance_of_a_random_sea_in_time_is_that_of_its_height() {
        let spectrum = Jonswap { hs: 4.0, tp: 9.0, gamma: 3.3 };
        let sea = Waves::new(&spectrum.waves(1, 200, 0.5), G, 80.0, 0.0);
        let count = 43_200;
        let samples: Vec<f64> = (0..count).map(|n| sea.elevation(&late(0.5 * f64::from(n)), 12.0, 7.0)).collect();
        let mean = samples.iter().sum::<f64>() / f64::from(count);
        let variance = samples.iter().map(|eta| (eta - mean).powi(2)).sum::<f64>() / f64::from(count);
        assert!(mean.abs() < 0.01, "{mean}");
        assert!((variance - 1.0).abs() < 0.01, "{variance}");
    }
}
