//! `waivers:`: findings that the owner has accepted.

use super::common::TEXT;
use super::form::{Date, Str};

grammar! {
    /// Accepts one finding of `fcproto diff` or `fcproto lint` until a date, with a reason. It affects the checks and not the protocol.
    /// 暂时接受 `fcproto diff` 或 `fcproto lint` 的一处提示，写明理由和期限。只影响检查，不影响协议。
    WAIVER: Waiver = "waiver" "豁免" {
        use TEXT.zh, TEXT.en;
        /// Name of the person who accepted it.
        /// 由谁接受。
        required by: Str, example "Li Wei";
        /// Last day or month of its validity.
        /// 有效期的最后一天或一个月。
        required until: Date;
    }
}
