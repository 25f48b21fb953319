// What is emitted as robot.ts: the robot's side.

import { Refusal, addExamples, addReports, serveRobot } from 'fc-protocol/runtime'
import type { Answer, Context, RawRequest, Server, ServerConfig, ServerPlatform } from 'fc-protocol/runtime'
import * as commands from './commands.ts'
import type * as messages from './messages.ts'
import { reports, service, toy } from './protocol_of.ts'

/** A complete robot: one method per command. What it cannot do, it refuses by throwing a `Refusal`. */
export interface Robot extends messages.DriveRobot {
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

/** The methods of each group of commands. */
export interface ExampleRobot extends messages.DriveExamples {}

/** Responds with the examples in the spec. */
export class ExampleRobot implements Robot {
  static {
    addExamples(ExampleRobot, service.methods)
  }

  /** Whether to answer also what would move a robot. */
  readonly pretendMotion: boolean

  /** `pretendMotion`: answers also what would move a robot. */
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

  /** Reports to the apps of a server. */
  constructor(server: Server) {
    this.server = server
  }
}

/** What the compiler says of a robot that lacks a method: `implements Robot` is the one word. */
export class Half implements PartialRobot {
  /** Refuses with a declared error. */
  startDrive(): never {
    throw Refusal.declared(commands.startDrive, 'Blocked')
  }
}
