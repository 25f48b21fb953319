// What is emitted as messages/GROUP.ts: plain types, and the values of enums.

import type { Extra } from 'fc-protocol/runtime'

/** Where the robot is. */
export type DriveState = 0 | 1 | 2 | 3 | (number & {})

/** Its values. */
export const DriveState = {
  /** It stands. */
  Idle: 0,
  /** It drives. */
  Driving: 1,
  /** It is there. */
  Arrived: 2,
  /** It cannot go on. */
  Stuck: 3,
} as const

/** Asks for the name: request. */
export interface GetNameRequest {
  /** Other keys, kept unchanged. */
  extra?: Extra
}

/** Asks for the name: response. */
export interface GetNameResponse {
  /** The name. */
  name: string
  /** Other keys, kept unchanged. */
  extra?: Extra
}

/** Drives: request. */
export interface StartDriveRequest {
  /** Where to. */
  target: string
  /** Other keys, kept unchanged. */
  extra?: Extra
}

/** Drives: response. */
export interface StartDriveResponse {
  /** Number of the drive. */
  drive: number
  /** Other keys, kept unchanged. */
  extra?: Extra
}

/** How far it has come. */
export interface DriveProgress {
  /** Number of the drive. */
  drive: number
  /** How far. */
  state?: DriveState | undefined
  /** Other keys, kept unchanged. */
  extra?: Extra
}

/** How far it has come: acknowledgement. */
export interface DriveProgressAck {
  /** Other keys, kept unchanged. */
  extra?: Extra
}

/** A scan, as JSON. */
export interface Scan {
  /** Distances in metres. */
  ranges: number[]
  /** Other keys, kept unchanged. */
  extra?: Extra
}
