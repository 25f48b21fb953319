// The form of the generated robot.ts: the robot's side.

import { Refusal, addExamples, addReports, serveRobot } from 'fc-protocol/runtime'
import type { Answer, Context, RawRequest, Server, ServerConfig, ServerPlatform } from 'fc-protocol/runtime'
import * as commands from './commands.ts'
import type * as messages from './messages.ts'
import { reports, service, toy } from './protocol_of.ts'

/** A complete robot: one method per command. It refuses by throwing a `Refusal`. */
export interface Robot extends messages.DriveRobot, Pick<PartialRobot, 'passThrough' | 'unknown'> {}

/** The methods of each group of commands. Each is optional. */
export interface PartialRobot extends messages.DrivePartialRobot {
  /** Codes 500 to 599 without a separate method: JSON in and out. Refused as unknown if absent. */
  passThrough?(request: RawRequest, context: Context): Answer<string>

  /** All other codes. Refused as unknown if absent. */
  unknown?(request: RawRequest, context: Context): Answer<string>
}

/** A robot with some of the commands. The others are refused as not implemented. */
export abstract class PartialRobot {}

/** Serves apps. */
export function serve(platform: ServerPlatform, robot: PartialRobot, config: ServerConfig = {}): Promise<Server> {
  return serveRobot(toy, service, platform, robot, config)
}

/** The methods of each group of commands. */
export interface ExampleRobot extends messages.DriveExamples {}

/** Responds with the examples in the spec. */
export class ExampleRobot implements Robot {
  static {
    addExamples(ExampleRobot, service.methods)
  }

  /** Responds also to commands that would move a robot. */
  readonly pretendMotion: boolean

  /** `pretendMotion`: responds also to commands that would move a robot. */
  constructor({ pretendMotion = false }: { pretendMotion?: boolean } = {}) {
    this.pretendMotion = pretendMotion
  }
}

/** The methods of each group. */
export interface Reporter extends messages.DriveReporter {}

/** Pushes reports: one method per report. */
export class Reporter {
  static {
    addReports(Reporter, reports)
  }

  /** The server. */
  protected readonly server: Server

  /** Creates the reporter of a server. */
  constructor(server: Server) {
    this.server = server
  }
}

/** A robot that lacks a method: the compiler refuses `implements Robot` for it. */
export class Half extends PartialRobot {
  /** Refuses with a declared error. */
  override startDrive(): never {
    throw Refusal.declared(commands.startDrive, 'Blocked')
  }
}
