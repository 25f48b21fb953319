// Adds the methods of a package's stubs. A package declares the methods in groups; each calls the runtime with its
// operation.

import type { CallOptions } from './client/config.ts'
import type { Connection } from './client/connection.ts'
import type { DataConnection } from './client/data.ts'
import type { AnyCommand, AnyReportOf, AnyStream, Command, Report, Stream } from './operation.ts'
import type { Server } from './server/server.ts'
import type { Audience, Context } from './server/types.ts'

/** A class of a package. */
export interface Stub {
  /** Holds its methods. */
  readonly prototype: object
}

/** Methods by name, as in an object literal: a stack trace shows the name. */
type Methods = Readonly<Record<string, (...parameters: never[]) => unknown>>

/** Adds methods to a class as its own body would. */
function add(stub: Stub, methods: Methods): void {
  for (const [name, value] of Object.entries(methods)) {
    Object.defineProperty(stub.prototype, name, { value, writable: true, configurable: true })
  }
}

/** Adds a method for each command to a client, which calls it. */
export function addCalls(client: Stub, commands: Readonly<Record<string, AnyCommand>>): void {
  for (const [name, command] of Object.entries(commands)) {
    add(client, {
      [name](this: Connection<unknown>, request: unknown = {}, options?: CallOptions) {
        return this.call(command as Command<unknown, unknown, string>, request, options)
      },
    })
  }
}

/**
 * Adds a method for each command to a robot, which returns the spec's example. For commands with motion it does so only
 * if `pretendMotion` is set.
 */
export function addExamples(robot: Stub, commands: Readonly<Record<string, AnyCommand>>): void {
  for (const [name, command] of Object.entries(commands)) {
    const moves = command.effect === 'motion' || command.effect === 'unknown'
    add(robot, {
      [name](this: { readonly pretendMotion: boolean }, _request: unknown, context: Context) {
        if (moves && !this.pretendMotion) throw context.notImplemented()
        return command.responseExample()
      },
    })
  }
}

/** Adds a method for each report to a reporter, which pushes it to the apps of a server. */
export function addReports(reporter: Stub, reports: Readonly<Record<string, AnyReportOf>>): void {
  for (const [name, report] of Object.entries(reports)) {
    add(reporter, {
      [name](this: { readonly server: Server }, body: unknown, audience: Audience = 'all') {
        return this.server.push(audience, report as Report<unknown>, body)
      },
    })
  }
}

/** Adds a method per stream to the app's stub: subscribe to a robot's stream, or send an app's stream. */
export function addAppStreams(streams: Stub, all: Readonly<Record<string, AnyStream>>): void {
  for (const [name, stream] of Object.entries(all)) {
    const of = stream as Stream<unknown>
    const methods: Methods =
      stream.from === 'robot'
        ? {
            [`subscribe${name}`](this: { readonly data: DataConnection }) {
              return this.data.subscribe(of)
            },
          }
        : {
            [`send${name}`](this: { readonly data: DataConnection }, id: number, content: unknown) {
              return this.data.sendStream(of, id, content)
            },
          }
    add(streams, methods)
  }
}

/** Adds a method for each of the robot's streams. It sends a frame to the data connections of a server. */
export function addRobotStreams(streamer: Stub, all: Readonly<Record<string, AnyStream>>): void {
  for (const [name, stream] of Object.entries(all)) {
    if (stream.from !== 'robot') continue
    add(streamer, {
      [`send${name}`](this: { readonly server: Server }, id: number, content: unknown, audience: Audience = 'all') {
        return this.server.sendStream(audience, stream as Stream<unknown>, id, content)
      },
    })
  }
}
