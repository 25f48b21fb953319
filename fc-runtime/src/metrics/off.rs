//! Metrics without a recorder: all functions are empty.

#![allow(
    clippy::extra_unused_type_parameters,
    clippy::unused_self,
    clippy::needless_pass_by_value,
    reason = "as in the other form"
)]

use super::Family;
use crate::protocol::Protocol;
use std::time::Duration;

#[derive(Debug)]
pub(crate) struct Counter;

impl Counter {
    #[inline]
    pub(crate) fn new(_name: &'static str, _help: &'static str) -> Self {
        Self
    }

    #[inline]
    pub(crate) fn add(&self, _n: u64) {}
}

#[derive(Debug)]
pub(crate) struct Gauge;

impl Gauge {
    #[inline]
    pub(crate) fn new(
        _name: &'static str,
        _help: &'static str,
        _port: Option<&'static str>,
    ) -> Self {
        Self
    }

    #[inline]
    pub(crate) fn hold(&self) -> Held {
        Held
    }
}

#[derive(Debug)]
pub(crate) struct Held;

#[derive(Debug)]
pub(crate) struct Operations;

impl Operations {
    #[inline]
    pub(crate) fn of<P: Protocol>(_family: &'static Family) -> Self {
        Self
    }

    #[inline]
    pub(crate) fn called(&self, _code: u16, _result: &'static str) {}

    #[inline]
    pub(crate) fn took(&self, _code: u16, _time: Duration) {}
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Since;

impl Since {
    #[inline]
    pub(crate) fn now() -> Self {
        Self
    }

    #[inline]
    pub(crate) fn elapsed(self) -> Duration {
        Duration::ZERO
    }
}
