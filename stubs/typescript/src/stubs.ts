// What gives the stubs of a package their methods. A package declares them, group by group; each does the same with an
// operation of its own.

import type { CallOptions } from './client/config.ts'
import type { Connection } from './client/connection.ts'
import type { DataConnection } from './client/data.ts'
import type { AnyCommand, AnyReportOf, AnyStream, Command, Report, Stream } from './operation.ts'
import type { Server } from './server/server.ts'
import type { Audience, Context } from './server/types.ts'

/** A class of a package. */
export interface Stub {
  /** Where its methods are. */
  readonly prototype: object
}

/** Methods by their names, as an object literal has them: a stack trace shows the name. */
type Methods = Readonly<Record<string, (...parameters: never[]) => unknown>>

/** Adds methods to a class as its own body would. */
function add(stub: Stub, methods: Methods): void {
  for (const [name, value] of Object.entries(methods)) {
    Object.defineProperty(stub.prototype, name, { value, writable: true, configurable: true })
  }
}

/** Gives a client a method for each command, which calls it. */
export function addCalls(client: Stub, commands: Readonly<Record<string, AnyCommand>>): void {
  for (const [name, command] of Object.entries(commands)) {
    add(client, {
      [name](this: Connection<unknown>, request: unknown = {}, options?: CallOptions) {
        return this.call(command as Command<unknown, unknown, string>, request, options)
      },
    })
  }
}

/** Gives a robot a method for each command, which answers with the spec's example; to what may move, if it is to pretend. */
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

/** Gives a reporter a method for each report, which pushes it to the apps of a server. */
export function addReports(reporter: Stub, reports: Readonly<Record<string, AnyReportOf>>): void {
  for (const [name, report] of Object.entries(reports)) {
    add(reporter, {
      [name](this: { readonly server: Server }, body: unknown, audience: Audience = 'all') {
        return this.server.push(audience, report as Report<unknown>, body)
      },
    })
  }
}

/** Gives the app's side of streams a method for each: to subscribe to one of the robot's, to send one of its own. */
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

/** Gives the robot's side of streams a method for each of its own, which sends it to the data connections of a server. */
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
