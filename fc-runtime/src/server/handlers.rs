//! Running handlers. A panic of a handler affects no other request, and handlers without a waiting app are detached.

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

/// Sends the result of a handler.
pub(super) type Answer<P, T> = fn(&Peer<P>, FrameId, &T);

/// Polls a handler for the first time, and answers if it is ready. If the handler panics, this panics too and sends
/// nothing.
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
        // After the response, a panic must not be answered any more.
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
    /// `None` after the end.
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

/// Runs however the handler ends, because dropping its values may panic.
impl<P: Protocol, F: Future> Drop for Handler<P, F> {
    fn drop(&mut self) {
        self.end();
    }
}

/// The handlers of one connection that were not ready at once.
#[derive(Default)]
pub(super) struct Handlers<P: Protocol> {
    waiting: FuturesUnordered<Waiting<P>>,
    /// Memory of their requests, in bytes.
    weight: usize,
    /// `true` if a new handler has not been polled here yet.
    fresh: bool,
}

impl<P: Protocol> Handlers<P> {
    pub(super) fn len(&self) -> usize {
        self.waiting.len()
    }

    pub(super) fn is_empty(&self) -> bool {
        self.waiting.is_empty()
    }

    /// Memory of their requests, in bytes.
    pub(super) fn weight(&self) -> usize {
        self.weight
    }

    /// Adds a handler, which is waited for until the deadline.
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

    /// Returns `true` if a handler has been added since the last call. It has not been polled here yet.
    pub(super) fn take_fresh(&mut self) -> bool {
        std::mem::take(&mut self.fresh)
    }

    /// Ready when a handler has ended and has been answered.
    pub(super) fn poll_next(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        match self.waiting.poll_next_unpin(cx) {
            Poll::Ready(Some(weight)) => {
                self.weight -= weight;
                Poll::Ready(())
            }
            Poll::Ready(None) | Poll::Pending => Poll::Pending,
        }
    }

    /// Detaches all handlers, because the app no longer waits.
    pub(super) fn abandon(&mut self) {
        for mut waiting in std::mem::take(&mut self.waiting) {
            waiting.abandon();
        }
        self.weight = 0;
    }
}

/// A handler with a waiting app and a deadline.
struct Waiting<P: Protocol> {
    /// `None` after it has been detached.
    handler: Option<Box<dyn RunningHandler>>,
    weight: usize,
    request: FrameId,
    peer: Arc<Peer<P>>,
    deadline: Pin<Box<Sleep>>,
}

/// Resolves to the memory of the request.
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
    /// Detaches the handler, because the app no longer waits.
    fn abandon(&mut self) {
        if let Some(handler) = self.handler.take()
            && handler.outlives()
            && (self.peer.detached).take_over(handler, self.peer.memory.lend_existing(self.weight))
        {
            self.peer.counters.handlers_abandoned.increment();
        }
    }
}
