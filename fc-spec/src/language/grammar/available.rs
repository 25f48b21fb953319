//! `availability:` and `available:`: the audiences, machines and releases of a thing.

use super::common::TEXT;
use super::form::{Entries, List, Name, Str};
use super::refers::Ref;

grammar! {
    /// The words that `available` uses: audiences, lines of machines, and series of releases.
    /// `available` 所用的词：面向谁、哪些机型、哪些版本。
    AVAILABILITY: Availability = "availability" "适用范围" {
        /// Audiences: kinds of app, by name.
        /// 受众：各种 app，以名称为键。
        optional audiences: Entries<Name, Audience, 1>, faults [UnusedAvailability];
        /// Lines of machines, by name.
        /// 机型，以名称为键。
        optional hardware: Entries<Name, Machine, 1>, faults [UnusedAvailability];
        /// Series of releases, such as those of a firmware, by name.
        /// 版本系列，例如某种固件的版本，以名称为键。
        optional releases: Entries<Name, Series, 1>, faults [UnusedAvailability];
    }

    /// A kind of app that has some things and lacks others.
    /// 一种 app：有的内容面向它，有的不面向它。
    _: Audience = "audience" "受众" {
        use TEXT.zh, TEXT.en;
    }

    /// A line of machines that differs from others.
    /// 与其他机型有差别的一种机型。
    _: Machine = "line of machines" "机型" {
        use TEXT.zh, TEXT.en;
    }

    /// A series of numbered releases.
    /// 一个版本系列。
    _: Series = "series of releases" "版本系列" {
        use TEXT.zh, TEXT.en;
    }

    /// The audiences, machines and releases that have a thing. A key that is left out limits nothing.
    /// 哪些受众、机型和版本才有；没有写的键不作限制。
    AVAILABLE: Available = "limit" "适用限制" {
        /// Only these audiences have it; `fcproto generate --for` leaves it out for others.
        /// 只面向这些受众；用 `fcproto generate --for` 为其他受众生成时不包含它。
        optional r#for: List<Ref<Audience>, 1>,
            example "[product_app]",
            faults [UnknownAvailability, LimitsNothing, LimitBeyondOperation];
        /// Only these lines of machines have it.
        /// 只有这些机型才有。
        optional hardware: List<Ref<Machine>, 1>, example "[second_generation]", faults [UnknownAvailability];
        /// The first release that has it, by series: `{ adp: "3.8" }`.
        /// 从哪个版本开始有，以版本系列为键：`{ adp: "3.8" }`。
        optional from: Entries<Ref<Series>, Str, 1>, example r#"{ adp: "3.8" }"#, faults [UnknownAvailability, BadRelease];
        /// The last release that has it, by series.
        /// 到哪个版本为止还有，以版本系列为键。
        optional until: Entries<Ref<Series>, Str, 1>,
            example r#"{ adp: "4.2" }"#,
            faults [UnknownAvailability, BadRelease, ReleasesOutOfOrder];
    }
}
