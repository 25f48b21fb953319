// The form of the generated groups/GROUP/messages.ts: plain types, the values of enums, and the methods of both sides.

import type {
  Acknowledgement,
  Answer,
  Audience,
  CallOptions,
  Context,
  Extra,
  FollowableCall,
  Reported,
  Subscription,
} from 'fc-protocol/runtime'

/** Where the robot is. */
export type DriveState = 0 | 1 | 2 | 3 | (number & {})

/** Its values. */
export const DriveState = {
  /** Idle. */
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

/** Progress of a drive. */
export interface DriveProgress {
  /** Number of the drive. */
  drive: number
  /** Progress. */
  state?: DriveState | undefined
  /** Other keys, kept unchanged. */
  extra?: Extra
}

/** Progress of a drive: acknowledgement. */
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

/** The commands of the group as an app calls them: methods of `Client`. */
export interface DriveCalls {
  /** Asks for the name. */
  getName(request: GetNameRequest, options?: CallOptions): Promise<GetNameResponse>

  /** Drives somewhere. */
  startDrive(request: StartDriveRequest, options?: CallOptions): FollowableCall<StartDriveResponse, DriveProgress>
}

/** Any report of the group: `case` tells which. */
export type DriveReport = Reported<'DriveProgress', DriveProgress>

/** The streams of the group on the app's side: methods of `Streams`. */
export interface DriveStreams {
  /** Scans, as JSON. */
  subscribeScans(): Subscription<Scan>

  /** Pictures, as raw bytes. */
  sendPictures(id: number, content: Uint8Array): Promise<void>
}

/** The commands of the group, each optional: methods of `PartialRobot`. */
export interface DrivePartialRobot {
  /** Asks for the name. */
  getName?(request: GetNameRequest, context: Context): Answer<GetNameResponse>

  /** Drives somewhere. */
  startDrive?(request: StartDriveRequest, context: Context): Answer<StartDriveResponse>
}

/** The commands of the group: methods of `Robot`. */
export interface DriveRobot extends Required<DrivePartialRobot> {}

/** The examples of the group: methods of `ExampleRobot`. */
export interface DriveExamples {
  /** The example. */
  getName(): GetNameResponse

  /** The example, if it is to pretend. */
  startDrive(request: StartDriveRequest, context: Context): StartDriveResponse
}

/** The reports of the group as a robot pushes them: methods of `Reporter`. */
export interface DriveReporter {
  /** Progress of a drive. Resolves to the outcome at each app. */
  driveProgress(report: DriveProgress, audience?: Audience): Promise<Acknowledgement[]>
}
