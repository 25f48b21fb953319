// What ties a request to its command, and a report to its code; the generated code specialises it.
#pragma once

namespace fc_runtime {

/// What a command does to the peer.
enum class Effect {
  Read,     ///< Only asks.
  Config,   ///< Changes what the peer knows or how it behaves.
  Motion,   ///< Sets something in motion.
  Unknown,  ///< Nobody knows: treated as what sets something in motion.
};

/// A request: `Response`, `code`, `name`, `effect`.
template <class Request>
struct Command;

/// A report: `code`, `name`; `has_state`, `is_end`, `is_failure` of a report, and `is_in_order` of one
/// after another.
template <class Message>
struct Report;

/// What ties a command to a report that it sets off: `is_of` says whether a report belongs to a call.
template <class Request, class Message>
struct SetsOff;

}  // namespace fc_runtime
