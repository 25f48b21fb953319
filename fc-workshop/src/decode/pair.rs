//! Pairs responses with their requests.

use crate::capture::Flow;
use fc_reflect::FrameId;
use fc_spec::model::Direction;
use std::collections::{HashMap, VecDeque};
use std::time::Duration;

/// Requests that are kept for their responses. With 4,096 of them, removals would make the table grow once more.
const KEPT: usize = 3500;

/// The request of a response.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Request {
    /// The position of the request in the input, or in its direction of the connection.
    pub offset: u64,
    /// The time from the request to the response, if the input has times.
    pub elapsed: Option<Duration>,
}

/// The flow of a request, and the id of its frame.
type Asked = (Option<Flow>, FrameId);

/// Requests without a response.
#[derive(Debug, Default)]
pub(super) struct Pairs {
    open: HashMap<Asked, (u64, Option<Duration>)>,
    order: VecDeque<Asked>,
}

impl Pairs {
    /// Keeps a request, or returns the request of a response. A repeated request counts from its last time.
    pub(super) fn pair(
        &mut self,
        flow: Option<Flow>,
        id: FrameId,
        offset: u64,
        time: Option<Duration>,
    ) -> Option<Request> {
        if id.direction == Direction::Response {
            let request = FrameId {
                direction: Direction::Request,
                ..id
            };
            let asked = (flow.map(Flow::reversed), request);
            let (offset, sent) = self.open.get(&asked)?;
            return Some(Request {
                offset: *offset,
                elapsed: time
                    .zip(*sent)
                    .and_then(|(now, sent)| now.checked_sub(sent)),
            });
        }
        let asked = (flow, id);
        if self.open.insert(asked, (offset, time)).is_none() {
            self.order.push_back(asked);
        }
        if self.order.len() > KEPT
            && let Some(oldest) = self.order.pop_front()
        {
            self.open.remove(&oldest);
        }
        None
    }
}
