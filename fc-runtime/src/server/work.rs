//! Handlers at work: each is polled, answered and dropped where its panic harms nobody else.

use super::peer::Peer;
use crate::frame::FrameId;
use crate::protocol::Protocol;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll, Waker, ready};
use tracing::instrument::Instrumented;

/// Sends what a handler has come to.
pub(super) type Answer<P, T> = fn(&Peer<P>, FrameId, &T);

/// A handler that waits.
pub(super) trait Work: Send {
    /// Goes on with it, and answers once there is an answer. Does not panic.
    fn poll(&mut self, cx: &mut Context<'_>) -> Poll<()>;
}

/// Polls a handler for the first time and answers if it is ready. Panics where the handler does,
/// without having answered.
pub(super) fn begin<P: Protocol, F>(
    peer: &Arc<Peer<P>>,
    request: FrameId,
    future: Instrumented<F>,
    answer: Answer<P, F::Output>,
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
    }))
}

struct Waits<P: Protocol, F: Future> {
    peer: Arc<Peer<P>>,
    request: FrameId,
    /// `None` once it has ended.
    future: Option<Pin<Box<Instrumented<F>>>>,
    answer: Answer<P, F::Output>,
}

impl<P: Protocol, F: Future> Waits<P, F> {
    fn end(&mut self) {
        if let Some(future) = self.future.take() {
            self.peer.guard(self.request, || drop(future));
        }
    }
}

impl<P: Protocol, F: Future + Send> Work for Waits<P, F> {
    fn poll(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        let Some(future) = &mut self.future else {
            return Poll::Ready(());
        };
        let (peer, request, answer) = (&self.peer, self.request, self.answer);
        let polled = peer.guard(request, || {
            let output = ready!(future.as_mut().poll(cx));
            future.span().in_scope(|| answer(peer, request, &output));
            Poll::Ready(output)
        });
        match polled {
            Some(Poll::Pending) => return Poll::Pending,
            Some(Poll::Ready(output)) => {
                peer.guard(request, || drop(output));
            }
            None => peer.refuse_after_panic(request),
        }
        self.end();
        Poll::Ready(())
    }
}

/// However it ends: the values of a handler may panic when they are dropped.
impl<P: Protocol, F: Future> Drop for Waits<P, F> {
    fn drop(&mut self) {
        self.end();
    }
}
