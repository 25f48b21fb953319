// Counters of a connection.

/** Counters of a connection since it was made, reconnecting included. */
export interface ClientCounters {
  /** Bytes received. */
  bytesIn: number
  /** Bytes handed to the connection to be sent. */
  bytesOut: number
  /** Responses that reached their call. */
  answers: number
  /** Responses that came after their call had ended. */
  lateAnswers: number
  /** Calls that ended without a response in time. */
  timeouts: number
  /** Reports queued for at least one receiver, and acknowledged. */
  reports: number
  /** Reports that did not fit into one receiver's queue while another receiver took them, counted per receiver. */
  reportsMissed: number
  /** Repeated reports, which were only acknowledged. */
  repeatedReports: number
  /** Reports left unacknowledged for lack of room or of a receiver. */
  reportsRefused: number
  /** Reports refused because their body or envelope is invalid. */
  reportsInvalid: number
  /** Reports that came later than one and a half intervals after the last of their kind. */
  reportsLate: number
  /** Reports in an order that the spec does not allow. Each `Following` counts its own. */
  reportsOutOfOrder: number
  /** Frames that could not be read. */
  badFrames: number
}

/** Returns counters at zero. */
export const newCounters = (): ClientCounters => ({
  bytesIn: 0,
  bytesOut: 0,
  answers: 0,
  lateAnswers: 0,
  timeouts: 0,
  reports: 0,
  reportsMissed: 0,
  repeatedReports: 0,
  reportsRefused: 0,
  reportsInvalid: 0,
  reportsLate: 0,
  reportsOutOfOrder: 0,
  badFrames: 0,
})
