//! The id of a station where that of a map is asked for.

use fc_derive::{Id, Message, New};

#[derive(Clone, Copy, Debug, PartialEq, Id)]
struct StationId(i64);

#[derive(Clone, Copy, Debug, PartialEq, Id)]
struct MapId(i64);

#[derive(Clone, Debug, PartialEq, Message, New)]
struct GetMapRequest {
    map_id: MapId,
    others: Option<Vec<MapId>>,
}

fn main() {
    let station = StationId(7);
    let _ = GetMapRequest::new(station).with_others(vec![station]);
    let _ = station == MapId(7);
    let _ = GetMapRequest::new(7);
}
