// What is emitted as robot.ts: the robot's side.

import { Refusal, serveRobot } from 'fc-protocol/runtime'
import type {
  Acknowledgement,
  Answer,
  Audience,
  Context,
  RawRequest,
  Server,
  ServerConfig,
  ServerPlatform,
} from 'fc-protocol/runtime'
import * as commands from './commands.ts'
import type * as messages from './messages.ts'
import { service, toy } from './protocol_of.ts'
import * as reports from './reports.ts'

/** A complete robot: one method per command. What it cannot do, it refuses by throwing a `Refusal`. */
export interface Robot {
  /** Asks for the name. */
  getName(request: messages.GetNameRequest, context: Context): Answer<messages.GetNameResponse>

  /** Drives somewhere. */
  startDrive(request: messages.StartDriveRequest, context: Context): Answer<messages.StartDriveResponse>

  /** Codes 500 to 599 that have no method of their own: JSON in and out. Refused as unknown without it. */
  passThrough?(request: RawRequest, context: Context): Answer<string>

  /** All other codes. Refused as unknown without it. */
  unknown?(request: RawRequest, context: Context): Answer<string>
}

/** A robot that has some of the commands so far: what is left out is refused as not implemented. */
export type PartialRobot = Partial<Robot>

/** Serves apps. */
export function serve(platform: ServerPlatform, robot: PartialRobot, config: ServerConfig = {}): Promise<Server> {
  return serveRobot(toy, service, platform, robot, config)
}

/** Responds with the examples in the spec. */
export class ExampleRobot implements Robot {
  private readonly pretendMotion: boolean

  /** `pretendMotion`: answers also what would move a robot. */
  constructor({ pretendMotion = false }: { pretendMotion?: boolean } = {}) {
    this.pretendMotion = pretendMotion
  }

  /** The example. */
  getName(): messages.GetNameResponse {
    return commands.getName.responseExample()
  }

  /** The example, if it is to pretend. */
  startDrive(_request: messages.StartDriveRequest, context: Context): messages.StartDriveResponse {
    if (!this.pretendMotion) throw context.notImplemented()
    return commands.startDrive.responseExample()
  }
}

/** Pushes reports: one method per report. */
export class Reporter {
  private readonly server: Server

  /** Reports to the apps of a server. */
  constructor(server: Server) {
    this.server = server
  }

  /** How far a drive has come. Resolves to what became of it at each app. */
  driveProgress(report: messages.DriveProgress, audience: Audience = 'all'): Promise<Acknowledgement[]> {
    return this.server.push(audience, reports.driveProgress, report)
  }
}

/** What the compiler says of a robot that lacks a method: `implements Robot` is the one word. */
export class Half implements PartialRobot {
  /** Refuses with a declared error. */
  startDrive(): never {
    throw Refusal.declared(commands.startDrive, 'Blocked')
  }
}
