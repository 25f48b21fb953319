// The end of a call, for metrics.

/** A call that has ended. */
export interface EndedCall {
  /** Name of the command; `unknown` for all codes that the spec does not have. */
  readonly operation: string
  /**
   * The result. At the client: `success`, the kind of the `CallError`, or `dropped` if the `signal` has aborted. At the
   * robot: `success`, `protocol`, `timeout`, `invalid`, `expired` or `refused`.
   */
  readonly result: string
  /** Milliseconds: at the client from the call to its end, at the robot from the request to its response. */
  readonly time: number
}
