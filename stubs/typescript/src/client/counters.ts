// What a connection has seen.

/** What a connection has seen since it was made, reconnecting included. */
export interface ClientCounters {
  /** Bytes received. */
  bytesIn: number
  /** Bytes handed to the connection to be sent. */
  bytesOut: number
  /** Answers that reached their call. */
  answers: number
  /** Answers nobody waited for any more. */
  lateAnswers: number
  /** Calls that ended without an answer in time. */
  timeouts: number
  /** Reports put into the queue of at least one receiver, and acknowledged. */
  reports: number
  /** Reports that one receiver had no room for while another one took them, counted per receiver. */
  reportsMissed: number
  /** Reports that came again and were only acknowledged. */
  repeatedReports: number
  /** Reports left unacknowledged because no receiver had room for them, or there was none. */
  reportsRefused: number
  /** Reports refused because they do not read as what their code says, or have no proper envelope. */
  reportsInvalid: number
  /** Reports that came more than one and a half of their intervals after the last of their kind. */
  reportsLate: number
  /** Reports that came in another order than the protocol says, counted by each who follows the process. */
  reportsOutOfOrder: number
  /** Frames that could not be read. */
  badFrames: number
}

/** Nothing seen. */
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
