//! Messages of three sizes, in the types of the protocol. They start as examples of the spec, so that they include keys
//! that the spec adds later.

use fc_derive::Message;
use fc_generated::{
    Fc, GetMapImageRequest, GetMapImageResponse, GetStationRequest, GetStationResponse, ListStationsResponse,
    ListedStation, ResponseEnvelope, StationPos, StationType,
};
use fc_runtime::{Bytes64, Command as _, Extra, FrameId, Message as _, Protocol as _, ResponseEnvelope as _};
use std::sync::LazyLock;

/// Time in the envelope of every message, in milliseconds since 1970.
pub const TIME: i64 = 1_667_823_500_544;
/// Id of the requested station.
pub const STATION: i64 = 1_671_124_918_008;
/// Name of the requested station.
pub const STATION_NAME: &str = "gate1";
/// Result code of success.
#[allow(clippy::cast_possible_truncation, reason = "as a message has it")]
pub const RESULT_CODE: i32 = Fc::RESULTS.success.code as i32;
/// Result text of success.
pub const RESULT_TEXT: &str = Fc::RESULTS.success.text;
/// Length of the picture of a map, in bytes. It has 1 MiB as base64 text.
pub const PICTURE: usize = 1024 * 1024 / 4 * 3;
/// Number of stations in a medium message.
pub const STATIONS: usize = 150;

/// Returns the id of a response frame.
#[must_use]
pub fn response_id(code: u16) -> FrameId {
    FrameId { response: true, kind: Fc::COMMAND, code, id: 90_842_323 }
}

/// Returns the id of a frame that responds with a station.
#[must_use]
pub fn station_id() -> FrameId {
    response_id(GetStationRequest::CODE)
}

/// Returns the id of a frame that responds with a map.
#[must_use]
pub fn map_id() -> FrameId {
    response_id(GetMapImageRequest::CODE)
}

/// Returns the envelope of every response.
#[must_use]
pub fn envelope() -> ResponseEnvelope {
    ResponseEnvelope::at(TIME, Fc::RESULTS.success.code, RESULT_TEXT)
}

/// Returns a request for a station, of about 60 bytes.
#[must_use]
pub fn station_request() -> GetStationRequest {
    static REQUEST: LazyLock<GetStationRequest> = LazyLock::new(|| {
        let mut request = GetStationRequest::example();
        request.data.station_id = STATION;
        request
    });
    REQUEST.clone()
}

/// Returns a request for the picture of a map.
#[must_use]
pub fn map_request() -> GetMapImageRequest {
    static REQUEST: LazyLock<GetMapImageRequest> = LazyLock::new(|| {
        let mut request = GetMapImageRequest::example();
        request.map_id = STATION;
        request
    });
    REQUEST.clone()
}

/// Returns a small message, about 150 bytes with the envelope.
#[must_use]
pub fn small(station: i64) -> GetStationResponse {
    static RESPONSE: LazyLock<GetStationResponse> = LazyLock::new(|| {
        let mut response = GetStationResponse::example();
        STATION_NAME.clone_into(&mut response.data.station_name);
        response.data.station_type = StationType::Navigation;
        response.data.x = 0.5;
        response.data.y = 0.6;
        response.data.yaw = 0.2;
        response
    });
    let mut response = RESPONSE.clone();
    response.data.station_id = station;
    response
}

/// A list of stations with positions as JSON numbers. No response of the spec has such a list.
#[derive(Clone, Debug, PartialEq, Message)]
pub struct StationList {
    /// The stations.
    pub stations: Vec<Station>,
    /// Unknown keys.
    #[fc(extra)]
    pub extra: Extra,
}

/// A station in a [`StationList`].
#[derive(Clone, Debug, PartialEq, Message)]
pub struct Station {
    /// Name.
    #[fc(key = "stationName")]
    pub station_name: String,
    /// Id.
    #[fc(key = "stationId")]
    pub station_id: i64,
    /// Id of the device at the station.
    #[fc(key = "deviceId")]
    pub device_id: String,
    /// Name of the map.
    #[fc(key = "mapName")]
    pub map_name: String,
    /// Position, in metres.
    pub x: f64,
    /// Position, in metres.
    pub y: f64,
    /// Direction, in radians.
    pub yaw: f64,
    /// Unknown keys.
    #[fc(extra)]
    pub extra: Extra,
}

/// Returns an angle or a length with five decimals.
fn number(index: usize, step: i32) -> f64 {
    let index = i32::try_from(index).unwrap_or(0);
    f64::from((index * step) % 2_000_000 - 1_000_000) / 100_000.0
}

fn station_number(index: usize) -> i64 {
    STATION + i64::try_from(index).unwrap_or(0) * 977
}

/// Returns a medium message, about 20 KB, with positions as JSON numbers.
#[must_use]
pub fn medium() -> StationList {
    let station = |index| Station {
        station_name: format!("station{index}"),
        station_id: station_number(index),
        device_id: format!("FC{}", 1_689_322_656_488 + index),
        map_name: "floor21".to_owned(),
        x: number(index, 42_947),
        y: number(index, 25_831),
        yaw: number(index, 5_305) / 4.0,
        extra: Extra::new(),
    };
    StationList { stations: (0..STATIONS).map(station).collect(), extra: Extra::new() }
}

/// Returns a medium message, about 20 KB, with positions as strings, as in the spec's list of stations.
#[must_use]
pub fn medium_text() -> ListStationsResponse {
    stations(STATIONS)
}

/// Returns the spec's list with this number of stations.
#[must_use]
pub fn stations(count: usize) -> ListStationsResponse {
    let example = ListedStation::example();
    let station = |index| {
        let mut station = example.clone();
        station.device_id = Some(format!("{}", 10_013_300_000_000_u64 + index as u64));
        station.station_id = station_number(index);
        station.station_name = format!("station{index}");
        station.station_pos = Some(StationPos::Outside);
        station.map_id = None;
        station.x = number(index, 42_947);
        station.y = number(index, 25_831);
        station.yaw = number(index, 5_305) / 4.0;
        station
    };
    let mut response = ListStationsResponse::example();
    response.stations = (0..count).map(station).collect();
    response
}

/// Returns bytes that do not compress.
#[must_use]
pub fn picture(length: usize) -> Vec<u8> {
    let mut state = 0x9E37_79B9_u32;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        state.to_le_bytes()[0]
    };
    (0..length).map(|_| next()).collect()
}

/// Returns a large message, a map with 1 MiB of base64 text.
#[must_use]
pub fn large() -> GetMapImageResponse {
    map_of(picture(PICTURE))
}

/// Returns a map with this picture.
#[must_use]
pub fn map_of(picture: Vec<u8>) -> GetMapImageResponse {
    let mut response = GetMapImageResponse::example();
    response.resolution = 0.05;
    response.origin.x = 1.0;
    response.origin.y = 1.0;
    response.origin.yaw = 1.0;
    response.occupied_thresh = 0.65;
    response.free_thresh = 0.196;
    response.png_map_bytes = Bytes64(picture);
    response
}
