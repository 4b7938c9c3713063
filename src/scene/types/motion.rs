//! The part `motion` of a scene: how fairleads move.

use crate::scene::types::vector::Triple;
use schemars::JsonSchema;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};

/// Motion of the fairleads.
#[derive(Debug, Clone, Default, PartialEq, Serialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Motion {
    /// The fairleads stay where the scene puts them.
    #[default]
    Fixed,
    /// Offset sine·sin(wt) + cosine·cos(wt), w = 2 pi/period, times xi²(3 - 2 xi), xi = t/ramp, until `ramp` seconds.
    Sinusoidal {
        /// Period [s], > 0.
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        period: f64,
        /// Amplitudes of the sine part [m]. Default 0.
        #[serde(default)]
        sine: Triple,
        /// Amplitudes of the cosine part [m]. Default 0.
        #[serde(default)]
        cosine: Triple,
        /// Length of the ramp [s], ≥ 0; 0 = none. Default: 3.25 periods.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0))]
        ramp: Option<f64>,
    },
    /// Absolute positions from a CSV file with columns t,x,y,z[,vx,vy,vz]; C1 interpolation.
    File {
        /// Path of the file, relative to the scene file.
        #[schemars(length(min = 1))]
        path: String,
    },
}

/// The keys of every kind of motion as one flat object. Read as a tagged enum, an error would not know the key it is about.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MotionKeys {
    kind: MotionKind,
    period: Option<f64>,
    sine: Option<Triple>,
    cosine: Option<Triple>,
    ramp: Option<f64>,
    path: Option<String>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum MotionKind {
    Fixed,
    Sinusoidal,
    File,
}

impl<'de> Deserialize<'de> for Motion {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let MotionKeys { kind, period, sine, cosine, ramp, path } = MotionKeys::deserialize(deserializer)?;
        let known: &'static [&'static str] = match kind {
            MotionKind::Fixed => &["kind"],
            MotionKind::Sinusoidal => &["kind", "period", "sine", "cosine", "ramp"],
            MotionKind::File => &["kind", "path"],
        };
        let given = [
            ("period", period.is_some()),
            ("sine", sine.is_some()),
            ("cosine", cosine.is_some()),
            ("ramp", ramp.is_some()),
            ("path", path.is_some()),
        ];
        if let Some((key, _)) = given.iter().find(|(key, given)| *given && !known.contains(key)) {
            return Err(D::Error::unknown_field(key, known));
        }
        Ok(match kind {
            MotionKind::Fixed => Motion::Fixed,
            MotionKind::Sinusoidal => Motion::Sinusoidal {
                period: period.ok_or_else(|| D::Error::missing_field("period"))?,
                sine: sine.unwrap_or_default(),
                cosine: cosine.unwrap_or_default(),
                ramp,
            },
            MotionKind::File => Motion::File { path: path.ok_or_else(|| D::Error::missing_field("path"))? },
        })
    }
}
