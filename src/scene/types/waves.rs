//! The part `environment.waves` of a scene.

use crate::scene::elevation_file::Record;
use schemars::JsonSchema;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use std::fmt::{self, Formatter};

/// One sea, or several that meet.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Seas {
    /// One sea.
    One(Waves),
    /// Several seas, wind sea and swell say, each of any kind and heading; their motions add up. They share one surface, so they agree on
    /// `stretching`; they are eased in together, over the longest `ramp`; and each is drawn anew, even where seeds agree.
    Several(#[schemars(length(min = 1))] Vec<Waves>),
}

impl From<Waves> for Seas {
    fn from(sea: Waves) -> Seas {
        Seas::One(sea)
    }
}

impl Seas {
    /// The seas.
    pub fn each(&self) -> &[Waves] {
        match self {
            Seas::One(sea) => std::slice::from_ref(sea),
            Seas::Several(seas) => seas,
        }
    }

    /// The seas, to be changed.
    pub fn each_mut(&mut self) -> &mut [Waves] {
        match self {
            Seas::One(sea) => std::slice::from_mut(sea),
            Seas::Several(seas) => seas,
        }
    }

    /// The only sea, where there is one.
    pub fn alone(&self) -> Option<&Waves> {
        match self.each() {
            [sea] => Some(sea),
            _ => None,
        }
    }

    /// The place of a sea in a scene.
    pub fn place(&self, index: usize) -> String {
        match self {
            Seas::One(_) => String::from("environment.waves"),
            Seas::Several(_) => format!("environment.waves[{index}]"),
        }
    }

    /// The stretching that all share: that of the first sea which names one.
    pub fn stretching(&self) -> Stretching {
        self.each().iter().find_map(Waves::stretching).unwrap_or_default()
    }

    /// Gives all seas that are drawn at random a seed; whether there are any.
    pub fn set_seed(&mut self, seed: u64) -> bool {
        self.each_mut().iter_mut().filter_map(Waves::seed_mut).map(|own| *own = seed).count() > 0
    }
}

/// An object is one sea, a list several: told apart by hand, so that what is wrong inside keeps its place and its words.
impl<'de> Deserialize<'de> for Seas {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Seas, D::Error> {
        struct OneOrSeveral;
        impl<'de> Visitor<'de> for OneOrSeveral {
            type Value = Seas;
            fn expecting(&self, formatter: &mut Formatter) -> fmt::Result {
                formatter.write_str("an object { } or a list of them")
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Seas, A::Error> {
                Waves::deserialize(MapAccessDeserializer::new(map)).map(Seas::One)
            }
            fn visit_seq<A: SeqAccess<'de>>(self, list: A) -> Result<Seas, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(list)).map(Seas::Several)
            }
        }
        deserializer.deserialize_any(OneOrSeveral)
    }
}

/// Waves by linear theory in water of `depth`, stretched to the surface.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Waves {
    /// One regular wave: elevation a·cos(k(x cos b + y sin b) - w t + phase).
    Regular {
        /// Amplitude [m], ≥ 0.
        #[schemars(range(min = 0.0))]
        amplitude: f64,
        /// Period [s], > 0.
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        period: f64,
        /// Direction of travel from +x towards +y [deg]. Default 0.
        #[serde(default)]
        direction_deg: f64,
        /// Phase at the origin at t = 0 [deg]. Default 0.
        #[serde(default)]
        phase_deg: f64,
        /// Time over which the amplitude is eased in [s], ≥ 0. Default: one period.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0))]
        ramp: Option<f64>,
        /// How the motion of still water is carried to the moving surface. Default `wheeler`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        stretching: Option<Stretching>,
    },
    /// One regular wave, steep or in shallow water: Stokes's expansion to the fifth order (Fenton 1985), crests higher than troughs are deep. It is a
    /// sea alone and needs no stretching.
    #[serde(rename = "regular-5th")]
    Regular5th {
        /// Height from trough to crest [m], > 0, at most what stands at this depth.
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        height: f64,
        /// Period [s], > 0, not so long that height × length² / depth³ passes 40.
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        period: f64,
        /// Direction of travel from +x towards +y [deg]. Default 0.
        #[serde(default)]
        direction_deg: f64,
        /// Phase at the origin at t = 0 [deg]; at 0 the crest is there. Default 0.
        #[serde(default)]
        phase_deg: f64,
        /// Time over which the amplitude is eased in [s], ≥ 0. Default: one period.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0))]
        ramp: Option<f64>,
    },
    /// A JONSWAP sea: components of equal energy at random frequencies with random phases.
    Jonswap {
        /// Significant wave height [m], ≥ 0.
        #[schemars(range(min = 0.0))]
        hs: f64,
        /// Peak period [s], > 0.
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        tp: f64,
        /// Peak enhancement [-], from 1 to 20. Default 3.3.
        #[serde(default = "jonswap_gamma")]
        #[schemars(range(min = 1.0, max = 20.0))]
        gamma: f64,
        /// Seed of the random frequencies and phases: the same seed, the same sea. Default 0.
        #[serde(default)]
        seed: u64,
        /// Number of components, 1 to 5000. Default 200.
        #[serde(default = "jonswap_components")]
        #[schemars(range(min = 1, max = 5000))]
        components: usize,
        /// Direction of travel from +x towards +y [deg]. Default 0.
        #[serde(default)]
        direction_deg: f64,
        /// Frequency above which the energy is left out [Hz], above the peak's. Default, and the most that is used: 5/tp.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        cut_off: Option<f64>,
        /// Time over which the amplitude is eased in [s], ≥ 0. Default: one peak period.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0))]
        ramp: Option<f64>,
        /// Directions of travel on both sides of `direction_deg`. Default: none, all travel in one direction.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        spreading: Option<Spreading>,
        /// How the motion of still water is carried to the moving surface. Default `wheeler`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        stretching: Option<Stretching>,
    },
    /// A full-grown sea of Pierson and Moskowitz (1964), by its height and peak: components as of `jonswap`.
    PiersonMoskowitz {
        /// Significant wave height [m], ≥ 0.
        #[schemars(range(min = 0.0))]
        hs: f64,
        /// Peak period [s], > 0.
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        tp: f64,
        /// Seed of the random frequencies and phases: the same seed, the same sea. Default 0.
        #[serde(default)]
        seed: u64,
        /// Number of components, 1 to 5000. Default 200.
        #[serde(default = "jonswap_components")]
        #[schemars(range(min = 1, max = 5000))]
        components: usize,
        /// Direction of travel from +x towards +y [deg]. Default 0.
        #[serde(default)]
        direction_deg: f64,
        /// Frequency above which the energy is left out [Hz], above the peak's. Default, and the most that is used: 5/tp.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        cut_off: Option<f64>,
        /// Time over which the amplitude is eased in [s], ≥ 0. Default: one peak period.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0))]
        ramp: Option<f64>,
        /// Directions of travel on both sides of `direction_deg`. Default: none, all travel in one direction.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        spreading: Option<Spreading>,
        /// How the motion of still water is carried to the moving surface. Default `wheeler`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        stretching: Option<Stretching>,
    },
    /// A sea of two peaks, swell and wind sea (Ochi & Hubble 1976), in one direction: components as of `jonswap`.
    OchiHubble {
        /// The two parts, in any order.
        parts: [OchiHubblePart; 2],
        /// Seed of the random frequencies and phases: the same seed, the same sea. Default 0.
        #[serde(default)]
        seed: u64,
        /// Number of components, 1 to 5000. Default 200.
        #[serde(default = "jonswap_components")]
        #[schemars(range(min = 1, max = 5000))]
        components: usize,
        /// Direction of travel from +x towards +y [deg]. Default 0.
        #[serde(default)]
        direction_deg: f64,
        /// Frequency above which the energy is left out [Hz], above both peaks'. Default, and the most that is used: 5/(the shorter tp).
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        cut_off: Option<f64>,
        /// Time over which the amplitude is eased in [s], ≥ 0. Default: the longer tp.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0))]
        ramp: Option<f64>,
        /// Directions of travel on both sides of `direction_deg`. Default: none, all travel in one direction.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        spreading: Option<Spreading>,
        /// How the motion of still water is carried to the moving surface. Default `wheeler`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        stretching: Option<Stretching>,
    },
    /// A spectrum given as a table, linear between its rows and nothing outside: components as of `jonswap`.
    Table {
        /// Rows of frequency [Hz], rising, and spectral density [m²/Hz], ≥ 0; at least 2. Their integral is hs²/16.
        #[schemars(length(min = 2))]
        spectrum: Vec<[f64; 2]>,
        /// Seed of the random frequencies and phases: the same seed, the same sea. Default 0.
        #[serde(default)]
        seed: u64,
        /// Number of components, 1 to 5000. Default 200.
        #[serde(default = "jonswap_components")]
        #[schemars(range(min = 1, max = 5000))]
        components: usize,
        /// Direction of travel from +x towards +y [deg]. Default 0.
        #[serde(default)]
        direction_deg: f64,
        /// Frequency above which the energy is left out [Hz], above the peak's. Default: that of the last row.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        cut_off: Option<f64>,
        /// Time over which the amplitude is eased in [s], ≥ 0. Default: the period of the row with the largest density.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0))]
        ramp: Option<f64>,
        /// Directions of travel on both sides of `direction_deg`. Default: none, all travel in one direction.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        spreading: Option<Spreading>,
        /// How the motion of still water is carried to the moving surface. Default `wheeler`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        stretching: Option<Stretching>,
    },
    /// A measured or computed elevation at a place: its Fourier components, all travelling in one direction. The sea repeats itself after the
    /// record. Either `path` or `series`.
    Elevation {
        /// CSV file with rows `t,eta` in s and m, evenly spaced, at least 16; relative to the scene's file.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        path: Option<String>,
        /// The same rows in the scene itself.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        series: Option<Vec<[f64; 2]>>,
        /// Place where the elevation is that of the record, x and y [m]. Default [0, 0].
        #[serde(default)]
        at: [f64; 2],
        /// Direction of travel from +x towards +y [deg]. Default 0.
        #[serde(default)]
        direction_deg: f64,
        /// Frequency above which the energy is left out [Hz], above the peak's. Default: five times the peak's.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(extend("exclusiveMinimum" = 0.0))]
        cut_off: Option<f64>,
        /// Time over which the amplitude is eased in [s], ≥ 0; the record is met from then on. Default: one period of the peak.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0))]
        ramp: Option<f64>,
        /// How the motion of still water is carried to the moving surface. Default `wheeler`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        stretching: Option<Stretching>,
    },
    /// A list of regular components.
    Components {
        /// The components, 1 to 5000.
        #[schemars(length(min = 1, max = 5000))]
        components: Vec<WaveComponent>,
        /// Time over which the amplitude is eased in [s], ≥ 0. Default: the longest period.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(range(min = 0.0))]
        ramp: Option<f64>,
        /// How the motion of still water is carried to the moving surface. Default `wheeler`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        stretching: Option<Stretching>,
    },
}

/// How the motion that linear theory knows below still water is carried to the surface, which moves. Above the surface the motion is that
/// at the surface.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Stretching {
    /// The motion at still water is put at the surface, and what lies between there and the bed is stretched along (Wheeler 1970).
    #[default]
    Wheeler,
    /// Linear theory as it stands, which ends at still water: nothing moves above it.
    None,
    /// Above still water the motion is that at still water.
    Vertical,
    /// Above still water the motion goes on as straight as its slope at still water.
    Extrapolation,
}

/// Directions of travel of a sea, spread as D(θ) ∝ cos^2s(θ/2), θ from `direction_deg` (Longuet-Higgins et al. 1963); either `s` or
/// `deviation_deg` says how much. Every direction holds the same energy.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Spreading {
    /// Exponent s [-], from 1 to 1000: a wind sea has 5 to 15, a swell 25 to 75.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1.0, max = 1000.0))]
    pub s: Option<f64>,
    /// Standard deviation √(2/(1 + s)) [deg], from 2.6 to 57.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 2.6, max = 57.0))]
    pub deviation_deg: Option<f64>,
    /// Number of directions, 2 to 100. Default 9.
    #[serde(default = "spreading_directions")]
    #[schemars(range(min = 2, max = 100))]
    pub directions: usize,
}

impl Spreading {
    /// The exponent s, by itself or from the standard deviation.
    pub fn exponent(&self) -> f64 {
        let of_deviation = |deviation: f64| 2.0 / deviation.to_radians().powi(2) - 1.0;
        self.s.or(self.deviation_deg.map(of_deviation)).unwrap_or(1.0)
    }
}

/// One of the two parts of an Ochi–Hubble sea.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OchiHubblePart {
    /// Significant wave height of the part [m], ≥ 0.
    #[schemars(range(min = 0.0))]
    pub hs: f64,
    /// Peak period of the part [s], > 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub tp: f64,
    /// How narrow the peak is [-], from 1 (a full-grown sea) to 20.
    #[schemars(range(min = 1.0, max = 20.0))]
    pub lambda: f64,
}

/// One component of a sea.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WaveComponent {
    /// Amplitude [m], ≥ 0.
    #[schemars(range(min = 0.0))]
    pub amplitude: f64,
    /// Period [s], > 0.
    #[schemars(extend("exclusiveMinimum" = 0.0))]
    pub period: f64,
    /// Direction of travel from +x towards +y [deg]. Default 0.
    #[serde(default)]
    pub direction_deg: f64,
    /// Phase at the origin at t = 0 [deg]. Default 0.
    #[serde(default)]
    pub phase_deg: f64,
}

impl Waves {
    /// The stretching that it names.
    pub fn stretching(&self) -> Option<Stretching> {
        match self {
            Waves::Regular { stretching, .. }
            | Waves::Jonswap { stretching, .. }
            | Waves::PiersonMoskowitz { stretching, .. }
            | Waves::OchiHubble { stretching, .. }
            | Waves::Table { stretching, .. }
            | Waves::Elevation { stretching, .. }
            | Waves::Components { stretching, .. } => *stretching,
            Waves::Regular5th { .. } => None,
        }
    }

    /// How its directions are spread, where they are.
    pub fn spreading(&self) -> Option<&Spreading> {
        match self {
            Waves::Jonswap { spreading, .. }
            | Waves::PiersonMoskowitz { spreading, .. }
            | Waves::OchiHubble { spreading, .. }
            | Waves::Table { spreading, .. } => spreading.as_ref(),
            Waves::Regular { .. } | Waves::Regular5th { .. } | Waves::Elevation { .. } | Waves::Components { .. } => None,
        }
    }

    /// The seed, of a sea that has one.
    pub fn seed(&self) -> Option<u64> {
        match self {
            Waves::Jonswap { seed, .. }
            | Waves::PiersonMoskowitz { seed, .. }
            | Waves::OchiHubble { seed, .. }
            | Waves::Table { seed, .. } => Some(*seed),
            Waves::Regular { .. } | Waves::Regular5th { .. } | Waves::Elevation { .. } | Waves::Components { .. } => None,
        }
    }

    fn seed_mut(&mut self) -> Option<&mut u64> {
        match self {
            Waves::Jonswap { seed, .. }
            | Waves::PiersonMoskowitz { seed, .. }
            | Waves::OchiHubble { seed, .. }
            | Waves::Table { seed, .. } => Some(seed),
            Waves::Regular { .. } | Waves::Regular5th { .. } | Waves::Elevation { .. } | Waves::Components { .. } => None,
        }
    }

    /// The record of an elevation that is in the scene, once it is read.
    pub fn record(&self) -> Option<Record> {
        match self {
            Waves::Elevation { series: Some(series), .. } => Record::new(series).ok(),
            _ => None,
        }
    }

    /// Significant height [m] and the peak period [s] of a sea that is given by its spectrum: of two parts the height of both together and
    /// the period of the higher one. None of waves given one by one.
    pub fn significant(&self) -> Option<(f64, f64)> {
        match self {
            Waves::Jonswap { hs, tp, .. } | Waves::PiersonMoskowitz { hs, tp, .. } => Some((*hs, *tp)),
            Waves::OchiHubble { parts: [one, other], .. } => {
                Some((one.hs.hypot(other.hs), if one.hs >= other.hs { one.tp } else { other.tp }))
            }
            Waves::Table { spectrum, .. } => {
                let peak = spectrum.iter().max_by(|one, other| one[1].total_cmp(&other[1]))?;
                Some((4.0 * variance(spectrum).sqrt(), peak[0].recip()))
            }
            Waves::Elevation { cut_off, .. } => {
                let record = self.record()?;
                Some((4.0 * record.variance(record.cut_off(*cut_off)).sqrt(), record.peak.recip()))
            }
            Waves::Regular { .. } | Waves::Regular5th { .. } | Waves::Components { .. } => None,
        }
    }
}

/// Variance of the elevation [m²] of a sea whose spectrum is a table of frequency [Hz] and density [m²/Hz], linear between its rows.
pub fn variance(spectrum: &[[f64; 2]]) -> f64 {
    spectrum.windows(2).map(|rows| 0.5 * (rows[0][1] + rows[1][1]) * (rows[1][0] - rows[0][0])).sum()
}

fn jonswap_gamma() -> f64 {
    3.3
}
fn spreading_directions() -> usize {
    9
}
fn jonswap_components() -> usize {
    200
}
