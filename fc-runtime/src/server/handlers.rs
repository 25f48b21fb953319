//! Handlers at handler: each is polled, answered and dropped where its panic harms nobody else, and left to itself when
//! nobody waits for it any more.

use super::peer::Peer;
use super::running_handler::{RunningHandler, StartedHandler, outlives};
use crate::frame::FrameId;
use crate::metrics::{Held, Since};
use crate::operation::Effect;
use crate::protocol::Protocol;
use futures_util::stream::{FuturesUnordered, StreamExt};
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll, Waker, ready};
use std::time::Instant;
use tokio::time::{Sleep, sleep_until};
use tracing::instrument::Instrumented;

/// Sends what a handler has come to.
pub(super) type Answer<P, T> = fn(&Peer<P>, FrameId, &T);

/// Polls a handler for the first time and answers if it is ready. Panics where the handler does,
/// without having answered.
pub(super) fn begin<P: Protocol, F>(
    peer: &Arc<Peer<P>>,
    request: FrameId,
    future: Instrumented<F>,
    answer: Answer<P, F::Output>,
    effect: fn(u16) -> Effect,
    waker: &Waker,
) -> Option<Box<dyn RunningHandler>>
where
    F: Future<Output: 'static> + Send + 'static,
{
    let since = Since::now();
    let mut future = Box::pin(future);
    let mut cx = Context::from_waker(waker);
    if let Poll::Ready(output) = future.as_mut().poll(&mut cx) {
        future.span().in_scope(|| answer(peer, request, &output));
        // From here on a panic must not be answered any more.
        peer.guard(request, || drop((future, output)));
        peer.counters.handled(request.code, since);
        return None;
    }
    Some(Box::new(Handler {
        since,
        _waiting: peer.counters.gauges.handlers.hold(),
        peer: Arc::clone(peer),
        request,
        future: Some(future),
        answer,
        effect,
    }))
}

struct Handler<P: Protocol, F: Future> {
    since: Since,
    _waiting: Held,
    peer: Arc<Peer<P>>,
    request: FrameId,
    /// `None` once it has ended.
    future: Option<Pin<Box<Instrumented<F>>>>,
    answer: Answer<P, F::Output>,
    effect: fn(u16) -> Effect,
}

impl<P: Protocol, F: Future> Handler<P, F> {
    fn end(&mut self) {
        if let Some(future) = self.future.take() {
            self.peer.guard(self.request, || drop(future));
            let (counters, code) = (&self.peer.counters, self.request.code);
            counters.handled(code, self.since);
        }
    }
}

impl<P: Protocol, F: Future + Send> RunningHandler for Handler<P, F> {
    fn poll(&mut self, cx: &mut Context<'_>, waits: bool) -> Poll<()> {
        let Some(future) = &mut self.future else {
            return Poll::Ready(());
        };
        let (peer, request, answer) = (&self.peer, self.request, self.answer);
        let polled = peer.guard(request, || {
            let output = ready!(future.as_mut().poll(cx));
            if waits {
                future.span().in_scope(|| answer(peer, request, &output));
            }
            Poll::Ready(output)
        });
        match polled {
            Some(Poll::Pending) => return Poll::Pending,
            Some(Poll::Ready(output)) => {
                peer.guard(request, || drop(output));
            }
            None if waits => peer.refuse_after_panic(request),
            None => {}
        }
        self.end();
        Poll::Ready(())
    }

    fn outlives(&self) -> bool {
        outlives((self.effect)(self.request.code))
    }
}

/// However it ends: the values of a handler may panic when they are dropped.
impl<P: Protocol, F: Future> Drop for Handler<P, F> {
    fn drop(&mut self) {
        self.end();
    }
}

/// The handlers of one connection that were not ready at once.
pub(super) struct Handlers<P: Protocol> {
    waiting: FuturesUnordered<Waiting<P>>,
    /// What their requests take in memory, in bytes.
    weight: usize,
    /// One has come that has not been polled in its place.
    fresh: bool,
}

impl<P: Protocol> Default for Handlers<P> {
    fn default() -> Self {
        Self {
            waiting: FuturesUnordered::new(),
            weight: 0,
            fresh: false,
        }
    }
}

impl<P: Protocol> Handlers<P> {
    pub(super) fn len(&self) -> usize {
        self.waiting.len()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.waiting.is_empty()
    }

    /// What their requests take in memory, in bytes.
    pub(super) fn weight(&self) -> usize {
        self.weight
    }

    /// Waits for one more, until the deadline.
    pub(super) fn push(
        &mut self,
        started: StartedHandler,
        request: FrameId,
        peer: &Arc<Peer<P>>,
        deadline: Instant,
    ) {
        self.weight += started.weight;
        self.fresh = true;
        self.waiting.push(Waiting {
            handler: Some(started.handler),
            weight: started.weight,
            request,
            peer: Arc::clone(peer),
            deadline: Box::pin(sleep_until(deadline.into())),
        });
    }

    /// Whether one has come that has not been polled in its place since this was last asked.
    pub(super) fn take_fresh(&mut self) -> bool {
        std::mem::take(&mut self.fresh)
    }

    /// Ready once one of them has ended, and been answered.
    pub(super) fn poll_next(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        match self.waiting.poll_next_unpin(cx) {
            Poll::Ready(Some(weight)) => {
                self.weight -= weight;
                Poll::Ready(())
            }
            Poll::Ready(None) | Poll::Pending => Poll::Pending,
        }
    }

    /// Nobody waits for their answers any more.
    pub(super) fn abandon(&mut self) {
        for mut waiting in std::mem::take(&mut self.waiting) {
            waiting.abandon();
        }
        self.weight = 0;
    }
}

/// A handler at handler that is waited for until its deadline.
struct Waiting<P: Protocol> {
    /// `None` once it is somebody else's.
    handler: Option<Box<dyn RunningHandler>>,
    weight: usize,
    request: FrameId,
    peer: Arc<Peer<P>>,
    deadline: Pin<Box<Sleep>>,
}

/// Resolves to what the request weighed.
impl<P: Protocol> Future for Waiting<P> {
    type Output = usize;

    fn poll(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<usize> {
        if let Some(handler) = &mut self.handler
            && handler.poll(cx, true).is_pending()
        {
            if self.deadline.as_mut().poll(cx).is_pending() {
                return Poll::Pending;
            }
            self.peer.refuse_with(self.request, P::RESULTS.timeout);
            self.abandon();
        }
        Poll::Ready(self.weight)
    }
}

impl<P: Protocol> Waiting<P> {
    /// Nobody waits for the answer any more.
    fn abandon(&mut self) {
        if let Some(handler) = self.handler.take()
            && handler.outlives()
            && (self.peer.detached).take_over(handler, self.peer.memory.lend(self.weight))
        {
            self.peer.counters.handlers_abandoned.one();
        }
    }
}
