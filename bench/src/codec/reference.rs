//! The floor of the codec: only `fast-md5` and `serde_json` on typed structs.
//!
//! The floor checks and writes the same bytes as the codec. It has no streams and no limits, drops unknown keys, and
//! panics on errors.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use fc_bench_cases::messages;
use fc_generated::{GetMapImageResponse, GetStationResponse, ListStationsResponse};
use flate2::{Compress, Compression, Crc, Decompress, FlushCompress, FlushDecompress};
use serde::de::{DeserializeOwned, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;

/// Length of a frame header, in bytes.
const HEADER: usize = 35;
/// Position of the digest in the header.
const DIGEST: std::ops::Range<usize> = 19..35;
/// Lengths of the header and the trailer of a gzip member, in bytes.
const WRAPPER: (usize, usize) = (10, 8);

/// A message of fc as a struct for serde.
pub trait Reference: Serialize + DeserializeOwned {
    /// Type of the message in fc.
    type Ours;
    /// Converts a message of fc.
    fn of(ours: &Self::Ours) -> Self;
}

macro_rules! body {
    ($name:ident { $($field:ident : $type:ty $(as $key:literal)? $(, with $with:literal)?;)* }) => {
        #[derive(Serialize, Deserialize)]
        #[serde(rename_all = "camelCase")]
        pub struct $name {
            $($(#[serde(rename = $key)])? $(#[serde(with = $with)])? $field: $type,)*
        }
    };
}

macro_rules! message {
    ($name:ident { $($field:ident : $type:ty $(as $key:literal)? $(, with $with:literal)?;)* }) => {
        body!($name {
            cmd_time: Option<i64>;
            result_code: i32;
            result_msg: Option<String>;
            $($field: $type $(as $key)? $(, with $with)?;)*
        });
    };
}

message!(Small { data: SmallData; });
body!(SmallData { station_name: String; station_id: i64; station_type: u8; x: f64; y: f64; yaw: f64; });
message!(Medium { stations: Vec<Station>; });
body!(Station {
    station_name: String; station_id: i64; device_id: String; map_name: String; x: f64; y: f64; yaw: f64;
});
message!(MediumText { stations: Vec<TextStation>; });
body!(TextStation {
    device_id: Option<String>; station_id: i64; station_name: String; station_pos: Option<Position>;
    x: f64, with "quoted"; y: f64, with "quoted"; yaw: f64, with "quoted";
});
message!(Large {
    image: String; resolution: f64; origin: Origin; occupied_thresh: f64; free_thresh: f64;
    png_map_bytes: Vec<u8> as "pngMapBtyes", with "base64_text";
});
message!(LargeText {
    image: String; resolution: f64; origin: Origin; occupied_thresh: f64; free_thresh: f64;
    png_map_bytes: String as "pngMapBtyes";
});
body!(Origin { x: f64; y: f64; yaw: f64; });

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Position {
    Outside,
    Inside,
}

/// Creates a message from the given fields of the body and the fixed fields of the envelope.
macro_rules! enveloped {
    ($name:ident { $($field:ident : $value:expr),* $(,)? }) => {
        $name {
            cmd_time: Some(messages::TIME),
            result_code: messages::envelope().result_code,
            result_msg: Some(messages::RESULT_TEXT.to_owned()),
            $($field: $value,)*
        }
    };
}

impl Reference for Small {
    type Ours = GetStationResponse;

    fn of(ours: &GetStationResponse) -> Self {
        let data = &ours.data;
        let data = SmallData {
            station_name: data.station_name.clone(),
            station_id: data.station_id,
            station_type: data.station_type.wire(),
            x: data.x,
            y: data.y,
            yaw: data.yaw,
        };
        enveloped!(Small { data: data })
    }
}

impl Reference for Medium {
    type Ours = messages::StationList;

    fn of(ours: &messages::StationList) -> Self {
        let station = |station: &messages::Station| Station {
            station_name: station.station_name.clone(),
            station_id: station.station_id,
            device_id: station.device_id.clone(),
            map_name: station.map_name.clone(),
            x: station.x,
            y: station.y,
            yaw: station.yaw,
        };
        enveloped!(Medium { stations: ours.stations.iter().map(station).collect() })
    }
}

impl Reference for MediumText {
    type Ours = ListStationsResponse;

    fn of(ours: &ListStationsResponse) -> Self {
        let station = |station: &fc_generated::ListedStation| TextStation {
            device_id: station.device_id.clone(),
            station_id: station.station_id,
            station_name: station.station_name.clone(),
            station_pos: Some(Position::Outside),
            x: station.x,
            y: station.y,
            yaw: station.yaw,
        };
        enveloped!(MediumText { stations: ours.stations.iter().map(station).collect() })
    }
}

fn origin(ours: &GetMapImageResponse) -> Origin {
    Origin { x: ours.origin.x, y: ours.origin.y, yaw: ours.origin.yaw }
}

impl Reference for Large {
    type Ours = GetMapImageResponse;

    fn of(ours: &GetMapImageResponse) -> Self {
        enveloped!(Large {
            image: ours.image.clone(),
            resolution: ours.resolution,
            origin: origin(ours),
            occupied_thresh: ours.occupied_thresh,
            free_thresh: ours.free_thresh,
            png_map_bytes: ours.png_map_bytes.0.clone(),
        })
    }
}

impl Reference for LargeText {
    type Ours = GetMapImageResponse;

    fn of(ours: &GetMapImageResponse) -> Self {
        enveloped!(LargeText {
            image: ours.image.clone(),
            resolution: ours.resolution,
            origin: origin(ours),
            occupied_thresh: ours.occupied_thresh,
            free_thresh: ours.free_thresh,
            png_map_bytes: STANDARD.encode(&ours.png_map_bytes.0),
        })
    }
}

impl Small {
    /// Returns the length of the station's name, which shows that the message was read.
    pub fn name_length(&self) -> usize {
        self.data.station_name.len()
    }
}

impl Large {
    /// Returns the length of the picture, which shows that the message was read.
    pub fn picture_length(&self) -> usize {
        self.png_map_bytes.len()
    }
}

/// A visitor that converts a string without copying it.
struct Parsed<T>(&'static str, fn(&str) -> Option<T>);

impl<T> Visitor<'_> for Parsed<T> {
    type Value = T;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.0)
    }

    fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<T, E> {
        self.1(text).ok_or_else(|| E::custom(self.0))
    }
}

/// Reads and writes a float as a string.
mod quoted {
    use super::{Deserializer, Parsed, Serializer};

    #[allow(clippy::trivially_copy_pass_by_ref, reason = "serde asks for a reference")]
    pub fn serialize<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(zmij::Buffer::new().format(*value))
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
        deserializer.deserialize_str(Parsed("a number in a string", |text| text.parse().ok()))
    }
}

/// Reads and writes bytes as base64.
mod base64_text {
    use super::{Deserializer, Parsed, STANDARD, Serializer};
    use base64::Engine as _;

    pub fn serialize<S: Serializer>(bytes: &[u8], serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&STANDARD.encode(bytes))
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<u8>, D::Error> {
        deserializer.deserialize_str(Parsed("base64", |text| STANDARD.decode(text).ok()))
    }
}

/// Checks the digest of a frame and returns the body.
fn checked(frame: &[u8]) -> &[u8] {
    let body = &frame[HEADER..];
    assert!(fast_md5::digest(body) == frame[DIGEST], "the digest is wrong");
    body
}

/// Reads an uncompressed frame.
pub fn decode<T: Reference>(frame: &[u8]) -> T {
    parse(checked(frame))
}

fn parse<T: Reference>(body: &[u8]) -> T {
    serde_json::from_slice(body).expect("the reference reads it")
}

/// Writes an uncompressed frame.
pub fn encode<T: Reference>(value: &T, out: &mut Vec<u8>) {
    out.clear();
    out.resize(HEADER, 0);
    serde_json::to_writer(&mut *out, value).expect("the reference writes it");
    seal(out);
}

fn seal(out: &mut [u8]) {
    let digest = fast_md5::digest(&out[HEADER..]);
    let total = u32::try_from(out.len()).expect("a short frame");
    out[11..15].copy_from_slice(&total.to_be_bytes());
    out[DIGEST].copy_from_slice(&digest);
}

/// Reads and writes compressed frames. The state of zlib is reused.
pub struct Gzip {
    inflate: Decompress,
    deflate: Compress,
    plain: Vec<u8>,
}

impl Gzip {
    /// Creates the state for a compression level of zlib.
    pub fn new(level: u8) -> Self {
        let deflate = Compress::new(Compression::new(level.into()), false);
        Self { inflate: Decompress::new(false), deflate, plain: Vec::new() }
    }

    /// Reads a compressed frame whose inflated body has `plain` bytes.
    pub fn decode<T: Reference>(&mut self, frame: &[u8], plain: usize) -> T {
        let body = checked(frame);
        let (deflated, trailer) = body[WRAPPER.0..].split_at(body.len() - WRAPPER.0 - WRAPPER.1);
        self.inflate.reset(false);
        self.plain.resize(plain, 0);
        self.inflate.decompress(deflated, &mut self.plain, FlushDecompress::Finish).expect("it inflates");
        assert_eq!(crc(&self.plain).to_le_bytes(), trailer[..4], "the sum is wrong");
        parse(&self.plain)
    }

    /// Writes a compressed frame.
    pub fn encode<T: Reference>(&mut self, value: &T, out: &mut Vec<u8>) {
        self.plain.clear();
        serde_json::to_writer(&mut self.plain, value).expect("the reference writes it");
        out.clear();
        out.resize(HEADER + WRAPPER.0, 0);
        out.reserve(self.plain.len() + self.plain.len() / 1000 + 64);
        self.deflate.reset();
        self.deflate.compress_vec(&self.plain, out, FlushCompress::Finish).expect("it deflates");
        out.extend_from_slice(&crc(&self.plain).to_le_bytes());
        out.extend_from_slice(&(self.plain.len() as u32).to_le_bytes());
        seal(out);
    }
}

fn crc(data: &[u8]) -> u32 {
    let mut crc = Crc::new();
    crc.update(data);
    crc.sum()
}
