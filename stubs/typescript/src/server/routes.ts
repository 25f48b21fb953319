// Maps requests to the methods of a robot.

import { keys, keysOf, textOf } from '../bodies.ts'
import type { Bodies } from '../bodies.ts'
import type { AnyCommand, Effect, ResultText } from '../operation.ts'
import type { Struct } from '../schema.ts'
import type { CodeRangeOf, ServiceOf } from '../wire.ts'
import type { Context } from './types.ts'

/** A decoded request. */
export interface RequestRead {
  /** The request. */
  readonly request: unknown
  /** Time the request was made; `null` if it carries no time. */
  readonly time: number | null
}

/** Handling of requests with one code. */
export interface Route {
  /** Effect on the robot. */
  readonly effect: Effect
  /** `true` if a running handler must not be cut off: its effect is motion or unknown. */
  readonly outlives: boolean
  /** Reads a request; throws a `BodyError`. */
  read(bodies: Bodies, code: number, data: Uint8Array): RequestRead
  /** Handles it. Throws a `Refusal` to refuse it. */
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

  /** Creates the routes of a robot, which may lack some methods. */
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

  /** Returns the route of a code; `null` for an unknown code. */
  of(code: number): Route | null {
    return (
      this.routes.get(code) ?? this.ranges.find(({ first, last }) => first <= code && code <= last)?.route ?? this.other
    )
  }

  /** Returns the spec's name of a code. */
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

/** Returns a route without types: JSON in, JSON out. */
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
