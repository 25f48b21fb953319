// What a robot has seen.

/** What a robot has seen since it was begun. */
export interface ServerCounters {
  /** Connections accepted at the command port. */
  connections: number
  /** Connections accepted at the data port. */
  dataConnections: number
  /** Connections closed at once because there were as many as there may be already, in total or from their address. */
  connectionsRefused: number
  /** Connections closed at once because none may come from their address. */
  connectionsForbidden: number
  /** Connections closed because memory was short and they held most of it. */
  connectionsEvicted: number
  /** Connections closed to make room for another, because nothing had come over them yet. */
  connectionsDisplaced: number
  /** Connections closed because a header did not come in time, a frame or a reader stalled, or nothing came for too long. */
  connectionsTimedOut: number
  /** Times that a connection was not read for a while because of useless work. */
  connectionsPaced: number
  /** Requests answered with success. */
  callsSucceeded: number
  /** Requests answered with the result of a protocol error. */
  callsProtocol: number
  /** Requests answered with the result of a timeout. */
  callsTimedOut: number
  /** Requests answered with the result of an invalid parameter. */
  callsInvalid: number
  /** Requests answered with the result of an expired message. */
  callsExpired: number
  /** Requests that a handler answered with another result. */
  callsRefused: number
  /** Requests refused because they may not be made from their address; among `callsProtocol`. */
  callsForbidden: number
  /** Requests refused because the robot does not implement a command of the spec; among `callsProtocol`. */
  callsNotImplemented: number
  /** Handlers that threw something else than a `Refusal`. Their requests are among `callsProtocol`, or `callsTimedOut` before. */
  handlersPanicked: number
  /** Handlers that ran on though nobody waited for their answer any more. */
  handlersAbandoned: number
  /** Requests refused because as many of these as `abandonedHandlers` were at work; among `callsProtocol`. */
  abandonedReached: number
  /** Times that a connection was not read because as many of its requests as may be were at work. */
  inFlightReached: number
  /** Frames that could not be read. */
  badFrames: number
  /** Reports sent for the first time, counted per app. */
  reportsSent: number
  /** Reports sent again. */
  reportsRepeated: number
  /** Reports acknowledged with success. */
  reportsAcknowledged: number
  /** Reports acknowledged with another result. */
  reportsRefused: number
  /** Reports given up after the last repetition. */
  reportsTimedOut: number
  /** Reports dropped because an app's queue was full. */
  reportsDropped: number
  /** Frames of streams received. */
  streamFramesIn: number
  /** Frames of streams sent. */
  streamFramesOut: number
  /** Frames of streams dropped because nobody took them. */
  streamFramesDropped: number
  /** Bytes received. */
  bytesIn: number
  /** Bytes sent. */
  bytesOut: number
}

/** Nothing seen. */
export const newCounters = (): ServerCounters => ({
  connections: 0,
  dataConnections: 0,
  connectionsRefused: 0,
  connectionsForbidden: 0,
  connectionsEvicted: 0,
  connectionsDisplaced: 0,
  connectionsTimedOut: 0,
  connectionsPaced: 0,
  callsSucceeded: 0,
  callsProtocol: 0,
  callsTimedOut: 0,
  callsInvalid: 0,
  callsExpired: 0,
  callsRefused: 0,
  callsForbidden: 0,
  callsNotImplemented: 0,
  handlersPanicked: 0,
  handlersAbandoned: 0,
  abandonedReached: 0,
  inFlightReached: 0,
  badFrames: 0,
  reportsSent: 0,
  reportsRepeated: 0,
  reportsAcknowledged: 0,
  reportsRefused: 0,
  reportsTimedOut: 0,
  reportsDropped: 0,
  streamFramesIn: 0,
  streamFramesOut: 0,
  streamFramesDropped: 0,
  bytesIn: 0,
  bytesOut: 0,
})
