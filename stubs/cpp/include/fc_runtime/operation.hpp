// Traits of requests and reports. The generated code specializes them.
#pragma once

namespace fc_runtime {

/// The effect of a command on the peer.
enum class Effect {
  Read,     ///< Only queries.
  Config,   ///< Changes the data or configuration of the peer.
  Motion,   ///< Moves the robot.
  Unknown,  ///< Unknown. Treated like `Motion`.
};

/// Traits of a request: `Response`, `code`, `name`, `effect`.
template <class Request>
struct Command;

/// Traits of a report: `code` and `name`. `has_state`, `is_end` and `is_failure` test one report;
/// `is_in_order` tests it against the previous one.
template <class Message>
struct Report;

/// Ties a command to the report of its process. `is_of` returns `true` if a report belongs to a
/// call.
template <class Request, class Message>
struct SetsOff;

}  // namespace fc_runtime
