//! Where the ends of lines are that hang on bodies and points, and how these move them.

use crate::algebra::rotation;
use crate::scene::bodies::{BodyMotion, Mount, PointMotion};
use crate::scene::types::{Line, Motion, Scene, Triple};
use nalgebra::Vector3;

impl Scene {
    /// Number of the body of a name.
    pub fn body(&self, name: &str) -> Option<usize> {
        self.bodies.iter().position(|body| body.name == name)
    }

    /// Number of the point of a name.
    pub fn point(&self, name: &str) -> Option<usize> {
        self.points.iter().position(|point| point.name == name)
    }

    /// Whether an end is on something that moves freely.
    pub fn is_on_free(&self, on: Option<&Mount>) -> bool {
        match on {
            Some(Mount::Body { body, .. }) => self.body(body).is_some_and(|body| self.bodies[body].is_free()),
            Some(Mount::Point { point }) => self.point(point).is_some_and(|point| self.points[point].is_free()),
            None => false,
        }
    }

    /// The same scene with a body fixed in a pose, position [m] and roll, pitch and yaw [deg].
    pub fn with_body_held(&self, body: usize, position: Triple, attitude_deg: Triple) -> Scene {
        let mut scene = self.clone();
        let own = &mut scene.bodies[body];
        (own.position, own.attitude_deg, own.motion) = (position, attitude_deg, BodyMotion::Fixed);
        scene.place_ends();
        scene
    }

    /// Puts the ends that hang on bodies and points where these are. What hangs on nothing that is known stays where it was.
    pub fn place_ends(&mut self) {
        let (bodies, points) = (&self.bodies, &self.points);
        let place = |on: &Option<Mount>| match on {
            Some(Mount::Body { body, at, .. }) => bodies.iter().find(|own| own.name == *body).map(|own| own.place(at).into()),
            Some(Mount::Point { point }) => points.iter().find(|own| own.name == *point).map(|own| own.position),
            None => None,
        };
        for line in &mut self.lines {
            line.fairlead = place(&line.fairlead_on).unwrap_or(line.fairlead);
            line.anchor = place(&line.anchor_on).unwrap_or(line.anchor);
        }
    }

    /// The motion of a line's fairlead relative to its anchor as far as a sinusoid says it, to first order in the angles: what meshes are made for.
    pub fn motion_of(&self, line: &Line) -> Motion {
        if line.fairlead_on.is_none() && line.anchor_on.is_none() {
            return self.motion.clone();
        }
        let fairlead = match &line.fairlead_on {
            None => self.motion.clone(),
            Some(on) => self.motion_on(on),
        };
        let anchor = line.anchor_on.as_ref().map_or(Motion::Fixed, |on| self.motion_on(on));
        match (fairlead, anchor) {
            (Motion::Sinusoidal { period, sine, cosine, ramp }, Motion::Sinusoidal { period: other, sine: s, cosine: c, .. })
                if period == other =>
            {
                let less = |a: Triple, b: Triple| std::array::from_fn(|axis| a[axis] - b[axis]);
                Motion::Sinusoidal { period, sine: less(sine, s), cosine: less(cosine, c), ramp }
            }
            (moving @ Motion::Sinusoidal { .. }, _) | (_, moving @ Motion::Sinusoidal { .. }) => moving,
            (other, _) => other,
        }
    }

    fn motion_on(&self, on: &Mount) -> Motion {
        match on {
            Mount::Body { body, at, .. } => {
                let Some(body) = self.body(body).map(|number| &self.bodies[number]) else { return Motion::Fixed };
                let BodyMotion::Sinusoidal { period, sine, cosine, ramp } = &body.motion else { return Motion::Fixed };
                let angles = body.attitude();
                let (turning, arm) = (rotation::rates_to_omega(&angles), body.place(at) - Vector3::from(body.position));
                let at_place = |six: &[f64; 6]| {
                    let turn = turning * Vector3::new(six[3], six[4], six[5]).map(f64::to_radians);
                    (Vector3::new(six[0], six[1], six[2]) + turn.cross(&arm)).into()
                };
                Motion::Sinusoidal { period: *period, sine: at_place(sine), cosine: at_place(cosine), ramp: *ramp }
            }
            Mount::Point { point } => match self.point(point).map(|number| &self.points[number].motion) {
                Some(PointMotion::Sinusoidal { period, sine, cosine, ramp }) => {
                    Motion::Sinusoidal { period: *period, sine: *sine, cosine: *cosine, ramp: *ramp }
                }
                _ => Motion::Fixed,
            },
        }
    }
}
