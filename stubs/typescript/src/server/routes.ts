// Which method of a robot handles a request.

import { keys, keysOf, textOf } from '../bodies.ts'
import type { Bodies } from '../bodies.ts'
import type { AnyCommand, Effect, ResultText } from '../operation.ts'
import type { Struct } from '../schema.ts'
import type { CodeRangeOf, ServiceOf } from '../wire.ts'
import type { Context } from './types.ts'

/** A request, read. */
export interface RequestRead {
  /** What is asked. */
  readonly request: unknown
  /** When it was made, if it says so. */
  readonly time: number | null
}

/** How requests of a code are handled. */
export interface Route {
  /** What it does to the robot. */
  readonly effect: Effect
  /** What has been begun must not be cut off: it moves something, or nobody knows what it does. */
  readonly outlives: boolean
  /** Reads a request; throws a `BodyError`. */
  read(bodies: Bodies, code: number, data: Uint8Array): RequestRead
  /** Handles it; throws what refuses it. */
  handle(request: unknown, context: Context): unknown
  /** Writes the response; throws a `BodyError`. */
  write(bodies: Bodies, success: ResultText, response: unknown): Uint8Array
}

type Method = (this: object, request: unknown, context: Context) => unknown

const outlives = (effect: Effect): boolean => effect === 'motion' || effect === 'unknown'

/** The methods of a robot, by code. */
export class Routes {
  private readonly routes = new Map<number, Route>()
  private readonly names = new Map<number, string>()
  private readonly ranges: readonly (CodeRangeOf & { readonly route: Route })[]
  private readonly other: Route | null

  /** Those of a robot, which may lack some. */
  constructor({ methods, ranges, unknown }: ServiceOf, robot: object) {
    const methodOf = (name: string): Method | undefined => {
      const method = (robot as Readonly<Record<string, unknown>>)[name]
      return typeof method === 'function' ? (method as Method) : undefined
    }
    for (const [name, command] of Object.entries(methods)) {
      if (command.code === null) continue
      this.names.set(command.code, command.name)
      this.routes.set(command.code, typed(command, robot, methodOf(name)))
    }
    this.ranges = ranges.flatMap((range) => {
      const method = methodOf(range.method)
      return method ? [{ ...range, route: raw(robot, method) }] : []
    })
    const other = methodOf(unknown)
    this.other = other ? raw(robot, other) : null
  }

  /** How a code is handled; `null` for an unknown one. */
  of(code: number): Route | null {
    return (
      this.routes.get(code) ?? this.ranges.find(({ first, last }) => first <= code && code <= last)?.route ?? this.other
    )
  }

  /** The spec's name of a code. */
  nameOf(code: number): string {
    return this.names.get(code) ?? 'unknown'
  }
}

function typed(command: AnyCommand, robot: object, method: Method | undefined): Route {
  return {
    effect: command.effect,
    outlives: outlives(command.effect),
    read: (bodies, _code, data) => {
      const { message, time } = bodies.readRequest(command.request as Struct<unknown>, data)
      return { request: message, time }
    },
    handle: (request, context) => {
      if (!method) throw context.notImplemented()
      return method.call(robot, request, context)
    },
    write: (bodies, success, response) => bodies.writeResponse(success, command.response as Struct<unknown>, response),
  }
}

/** JSON in, JSON out. */
function raw(robot: object, method: Method): Route {
  return {
    effect: 'unknown',
    outlives: true,
    read: (bodies, code, data) => {
      const { message, time } = bodies.readRequest(keys, data)
      return { request: { code, json: textOf(message) }, time }
    },
    handle: (request, context) => method.call(robot, request, context),
    write: (bodies, success, response) => bodies.writeResponse(success, keys, keysOf(response, bodies.allowed)),
  }
}
