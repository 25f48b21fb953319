// Counters of a robot.

/** Counters of a robot since it was started. */
export interface ServerCounters {
  /** Connections accepted at the command port. */
  connections: number
  /** Connections accepted at the data port. */
  dataConnections: number
  /** Connections closed at once at the limit, in total or from their address. */
  connectionsRefused: number
  /** Connections closed at once because their address is not allowed. */
  connectionsForbidden: number
  /** Connections closed because memory was short and they held most of it. */
  connectionsEvicted: number
  /** Silent connections closed to make room for another. */
  connectionsDisplaced: number
  /** Connections closed by a timeout: of a header, of a stalled frame or reader, or of silence. */
  connectionsTimedOut: number
  /** Times a connection was not read for a while because of useless frames. */
  connectionsPaced: number
  /** Requests with a response of success. */
  callsSucceeded: number
  /** Requests with the result for a protocol error. */
  callsProtocol: number
  /** Requests with the result for a timeout. */
  callsTimedOut: number
  /** Requests with the result for an invalid parameter. */
  callsInvalid: number
  /** Requests with the result for an expired message. */
  callsExpired: number
  /** Requests to which a handler gave another result. */
  callsRefused: number
  /** Requests refused because their address does not allow them; included in `callsProtocol`. */
  callsForbidden: number
  /** Requests refused because the robot does not implement their command; included in `callsProtocol`. */
  callsNotImplemented: number
  /**
   * Handlers that threw an error other than a `Refusal`. Their requests are included in `callsProtocol`, or earlier in
   * `callsTimedOut`.
   */
  handlersPanicked: number
  /** Handlers that were still running when their response was no longer awaited. */
  handlersAbandoned: number
  /** Requests refused because `abandonedHandlers` of these were running; included in `callsProtocol`. */
  abandonedReached: number
  /** Times a connection was not read because it had the most requests in flight. */
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
  /** Frames of streams dropped for lack of a receiver. */
  streamFramesDropped: number
  /** Bytes received. */
  bytesIn: number
  /** Bytes sent. */
  bytesOut: number
}

/** Returns counters at zero. */
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
