//! Handlers at work: each is polled, answered and dropped where its panic harms nobody else.

use super::peer::Peer;
use crate::frame::FrameId;
use crate::protocol::{Effect, Protocol};
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll, Waker, ready};
use tracing::instrument::Instrumented;

/// What moves must not stop because an app is gone, and what nobody knows may move.
pub(super) fn outlives(effect: Effect) -> bool {
    matches!(effect, Effect::Motion | Effect::Unknown)
}

/// Sends what a handler has come to.
pub(super) type Answer<P, T> = fn(&Peer<P>, FrameId, &T);

/// A handler that waits.
pub(super) trait Work: Send {
    /// Goes on with it; once it has ended, its answer is sent if somebody `waits` for it. Does not
    /// panic.
    fn poll(&mut self, cx: &mut Context<'_>, waits: bool) -> Poll<()>;

    /// Whether it runs to its end also when nobody waits for its answer any more.
    fn outlives(&self) -> bool;
}

/// Polls a handler for the first time and answers if it is ready. Panics where the handler does,
/// without having answered.
pub(super) fn begin<P: Protocol, F>(
    peer: &Arc<Peer<P>>,
    request: FrameId,
    future: Instrumented<F>,
    answer: Answer<P, F::Output>,
    effect: fn(u16) -> Effect,
    waker: &Waker,
) -> Option<Box<dyn Work>>
where
    F: Future<Output: 'static> + Send + 'static,
{
    let mut future = Box::pin(future);
    let mut cx = Context::from_waker(waker);
    if let Poll::Ready(output) = future.as_mut().poll(&mut cx) {
        future.span().in_scope(|| answer(peer, request, &output));
        // From here on a panic must not be answered any more.
        peer.guard(request, || drop((future, output)));
        return None;
    }
    Some(Box::new(Waits {
        peer: Arc::clone(peer),
        request,
        future: Some(future),
        answer,
        effect,
    }))
}

struct Waits<P: Protocol, F: Future> {
    peer: Arc<Peer<P>>,
    request: FrameId,
    /// `None` once it has ended.
    future: Option<Pin<Box<Instrumented<F>>>>,
    answer: Answer<P, F::Output>,
    effect: fn(u16) -> Effect,
}

impl<P: Protocol, F: Future> Waits<P, F> {
    fn end(&mut self) {
        if let Some(future) = self.future.take() {
            self.peer.guard(self.request, || drop(future));
        }
    }
}

impl<P: Protocol, F: Future + Send> Work for Waits<P, F> {
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
impl<P: Protocol, F: Future> Drop for Waits<P, F> {
    fn drop(&mut self) {
        self.end();
    }
}
