//! `waivers:`: breaks that the owner has accepted.

use super::common::TEXT;
use super::form::{Date, Str};

grammar! {
    /// A finding of `fcproto diff` or `fcproto lint` that is accepted until a date, and why. It does not apply to the protocol, only to its checks.
    /// 暂时接受 `fcproto diff` 或 `fcproto lint` 的一处提示，写明理由和期限。只影响检查，不影响协议。
    WAIVER: Waiver = "waiver" "豁免" {
        use TEXT.zh, TEXT.en;
        /// Who has accepted it.
        /// 由谁接受。
        required by: Str, example "Li Wei";
        /// Last day or month for which it holds.
        /// 有效期的最后一天或一个月。
        required until: Date;
    }
}
