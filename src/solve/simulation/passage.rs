//! Going through time: along the path of the fairlead, with the work done on the vessel, or at rest without a step.

use super::{REST_SHARE, SLIGHT, Simulation};
use crate::error::{Cause, Error, Stuck, Zone};
use crate::solve::controller::Failure;
use crate::solve::counters::LastStep;
use crate::solve::mixed::{Advance, Velocity};
use crate::solve::motion::{Ends, Kinematics, Path};
use crate::solve::newton::{Stall, motion};
use crate::solve::outputs;
use crate::solve::rest;
use crate::solve::scheme::{Bench, Moment, Stages};
use nalgebra::Vector3;

/// How far `cable-1994` may leave the path of its fairlead, as a share of the line's length: it prescribes the velocity and adds it up.
const MIXED_JUMP: f64 = 1.0e-4;

impl Simulation {
    /// Advances to a time with the fairlead on a path. On an error the state is the one before the call. A line at rest whose
    /// fairlead stays where it is takes no steps.
    pub fn advance(&mut self, until: f64, path: &Path) -> Result<(), Error> {
        self.go(until, path, None)
    }

    /// The same with both ends on paths.
    pub fn advance_ends(&mut self, until: f64, ends: &Ends) -> Result<(), Error> {
        self.go(until, &ends.fairlead, moving(&ends.anchor))
    }

    // A function of its own in every build: `tests/bench/callgrind.py` counts what it takes.
    #[inline(never)]
    fn go(&mut self, until: f64, path: &Path, anchor: Option<&Path>) -> Result<(), Error> {
        self.check_path(until, path, anchor)?;
        let begin = self.moment.state.clock.now;
        self.mark();
        let leaves = |path: &Path| !path.stays_at(self.anchor.y, begin, until);
        if self.line.is_planar() && (leaves(path) || anchor.is_some_and(leaves)) {
            self.leave_plane();
        }
        if self.rests(until, path, anchor) {
            (self.moment.state.clock.now, self.last) = (until, LastStep::default());
            return Ok(());
        }
        let effort = self.newton.effort;
        let steps = self.controller.tally.steps;
        self.controller.tally.error = 0.0;
        let outcome = if self.mixed.is_some() {
            self.run_mixed(until, &|time| path.at(time).velocity)
        } else {
            self.begin(path, anchor).and_then(|()| self.run(until, path, anchor))
        };
        match outcome {
            Ok(()) => {
                self.last = LastStep {
                    substeps: self.controller.tally.steps - steps,
                    newton_iterations: self.newton.effort.iterations - effort.iterations,
                    error_estimate: self.controller.tally.error,
                };
                Ok(())
            }
            Err(failure) => {
                let stuck = self.stuck(&failure, path, begin);
                self.undo();
                Err(Error::Step(Box::new(stuck)))
            }
        }
    }

    /// Whether nothing would happen before `until`. Depends on the state and the path alone, so that it is the same after a rollback.
    fn rests(&mut self, until: f64, path: &Path, anchor: Option<&Path>) -> bool {
        let (line, state) = (self.line.as_ref(), &self.moment.state);
        let (last, slight) = (line.last(), SLIGHT * line.mesh().length);
        let still = self.demands.fixed_step.is_none()
            && self.surroundings.waves.is_none()
            && self.supports.holds.is_empty()
            && state.holds.nodes() == 0
            && (self.fresh || state.v.position(last) == Vector3::zeros() && state.a.position(last) == Vector3::zeros())
            && path.rests(state.clock.now, until, &state.u.position(last), slight)
            && anchor.is_none_or(|anchor| anchor.rests(state.clock.now, until, &state.u.position(0), slight));
        if still && !self.resting {
            let allowed = REST_SHARE * self.tolerance * line.end_force(&motion(state)).norm();
            self.resting = rest::rests(line, &mut self.newton, state, allowed);
        }
        self.resting &= still;
        self.resting
    }

    fn run(&mut self, until: f64, path: &Path, anchor: Option<&Path>) -> Result<(), Failure> {
        let line = self.line.as_ref();
        let end = |moment: &Moment| (line.end_force(&motion(&moment.state)), moment.state.u.position(line.last()));
        let mut before = self.works.then(|| end(&self.moment));
        let work = &mut self.work;
        let (criteria, allowed) = (self.demands.criteria, self.demands.error);
        let mut bench = Bench { line, newton: &mut self.newton, path, anchor, criteria, allowed, stages: Stages::Solve };
        let anchor_end = |moment: &Moment| (outputs::anchor_force(line, &moment.state), moment.state.u.position(0));
        let mut anchor_before = anchor.filter(|_| self.works).map(|_| anchor_end(&self.moment));
        let anchor_work = &mut self.anchor_work;
        self.controller.advance(&mut bench, &self.demands, &mut self.moment, until, |moment, _| {
            if let Some((force, place)) = &mut anchor_before {
                let (force_now, place_now) = anchor_end(moment);
                *anchor_work += 0.5 * (*force + force_now).dot(&(place_now - *place));
                (*force, *place) = (force_now, place_now);
            }
            if let Some((force, place)) = &mut before {
                let (force_now, place_now) = end(moment);
                *work += 0.5 * (*force + force_now).dot(&(place_now - *place));
                (*force, *place) = (force_now, place_now);
            }
        })
    }

    /// The same by the report's own method.
    pub(super) fn run_mixed(&mut self, until: f64, velocity: Velocity) -> Result<(), Failure> {
        let Some(mixed) = &mut self.mixed else { return Ok(()) };
        let Advance { steps, pushing, work } = mixed.advance(&mut self.moment, until, velocity)?;
        self.fresh = false;
        self.work += work;
        self.controller.tally.steps += steps;
        self.controller.tally.pushing += pushing;
        self.newton.effort.iterations += steps;
        self.newton.effort.factorisations += steps;
        Ok(())
    }

    /// Before the first step after statics: the fairlead takes up the velocity and acceleration of its path, the line those that fit.
    fn begin(&mut self, path: &Path, anchor: Option<&Path>) -> Result<(), Failure> {
        if !std::mem::take(&mut self.fresh) {
            return Ok(());
        }
        let (time, criteria) = (self.moment.state.clock.now, self.demands.criteria);
        let mut bench = Bench {
            line: self.line.as_ref(),
            newton: &mut self.newton,
            path,
            anchor,
            criteria,
            allowed: self.demands.error,
            stages: Stages::Solve,
        };
        begin(&mut bench, &mut self.moment).map_err(|stall| Failure { time, step: 0.0, stall: Some(stall) })
    }

    fn check_path(&self, until: f64, path: &Path, anchor: Option<&Path>) -> Result<(), Error> {
        let (time, length) = (self.moment.state.clock.now, self.line.mesh().length);
        let (from, to) = (path.at(time), path.at(until));
        let held = Kinematics::at_rest(self.anchor);
        let (anchor_from, anchor_to) = anchor.map_or((held, held), |anchor| (anchor.at(time), anchor.at(until)));
        let jump = |end: &Kinematics, node: usize| (end.position - self.moment.state.u.position(node)).norm();
        let (last, allowed) = (self.line.last(), self.mixed.as_ref().map_or(1e-6, |_| MIXED_JUMP) * length);
        let reach = (to.position - anchor_to.position).norm();
        let (zone, cause) = if !([&from, &to].into_iter().all(is_finite) && until.is_finite()) {
            (Zone::Fairlead, Cause::BadMotion)
        } else if ![&anchor_from, &anchor_to].into_iter().all(is_finite) {
            (Zone::Anchor, Cause::BadMotion)
        } else if self.line.is_pinned(last) && jump(&from, last) > allowed {
            (Zone::Fairlead, Cause::Jump { distance: jump(&from, last) })
        } else if anchor.is_some() && self.line.is_pinned(0) && jump(&anchor_from, 0) > allowed {
            (Zone::Anchor, Cause::Jump { distance: jump(&anchor_from, 0) })
        } else if self.line.is_pinned(last) && reach > 2.0 * length {
            (Zone::Fairlead, Cause::OutOfReach { distance: reach, length })
        } else {
            return Ok(());
        };
        Err(Error::Step(Box::new(Stuck {
            line: self.name.clone(),
            time: until,
            s: if zone == Zone::Anchor { length } else { 0.0 },
            zone,
            cause,
            fairlead_speed: to.velocity.norm(),
            last_good_time: self.moment.state.clock.now,
        })))
    }
}

/// The fairlead takes up the velocity and acceleration of its path, the line the accelerations that fit.
pub(super) fn begin(bench: &mut Bench, moment: &mut Moment) -> Result<(), Stall> {
    let now = moment.state.clock;
    bench.prescribe(&mut moment.state, now);
    bench.accelerate(&mut moment.state)
}

/// The path of an anchor that may move.
pub(super) fn moving(anchor: &Path) -> Option<&Path> {
    Some(anchor).filter(|path| !matches!(path, Path::Fixed(_)))
}

fn is_finite(k: &Kinematics) -> bool {
    [k.position, k.velocity, k.acceleration].iter().all(|v| v.iter().all(|x| x.is_finite()))
}
