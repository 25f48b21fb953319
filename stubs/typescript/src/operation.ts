// Commands, reports and streams as values with types. A package has one constant for each.

import type { Text } from './protocol.ts'
import type { AnyEnum, AnyStruct, Enum, Struct, Tagged } from './schema.ts'
import type { AckPolicy } from './session.ts'

/** Effect of a command on the robot. */
export type Effect =
  /** Only reads. */
  | 'read'
  /** Changes the robot's settings or behaviour. */
  | 'config'
  /** Sets something in motion. */
  | 'motion'
  /** Unknown: never repeated automatically, like a command that sets something in motion. */
  | 'unknown'

/** A result code and its text. */
export interface ResultText {
  /** Code. */
  readonly code: number
  /** Text. */
  readonly text: string
}

/** Some values of an enum. */
export interface States {
  /** The enum. */
  readonly of: AnyEnum
  /** Its values. */
  readonly values: readonly (number | bigint | string)[]
}

/** Conditions under which a command is accepted. */
export interface Preconditions {
  /**
   * The states that accept it: `any`, or those in which each of these enums has one of these values. Absent where the
   * spec does not specify them.
   */
  readonly states?: 'any' | readonly States[]
  /** Names of the commands that come first. */
  readonly after: readonly string[]
}

/** When a report is sent. A path has wire keys from the report's body on, joined by dots. */
export type Cadence =
  /** At each change of a field. */
  | { readonly is: 'on_change'; readonly field: string }
  /** At each step of a number. */
  | { readonly is: 'step'; readonly field: string; readonly by: number }
  /** Every `ms` milliseconds. */
  | { readonly is: 'every'; readonly ms: number }
  /** Within `ms` milliseconds after a command that sets it off. */
  | { readonly is: 'within'; readonly ms: number }

/** Facts common to every operation. */
export interface OperationFacts {
  /** Name in the spec. */
  readonly name: string
  /** Command code; `null` while the spec has assigned none: then the operation cannot be sent. */
  readonly code: number | null
  /** Title in both languages. */
  readonly title: Text
  /** First version of the spec that has it, as `YYYY-MM` or `YYYY-MM-DD`. */
  readonly since?: string
  /** `true` if it is deprecated. */
  readonly deprecated?: boolean
  /** Path of its page below the documentation's root. */
  readonly docs: string
  /** File of the spec that defines it. */
  readonly spec: string
}

/** An operation that declares results besides success. */
export interface Declares<Failure extends string> {
  /** The declared results besides success, by name. */
  readonly errors: Readonly<Record<Failure, ResultText>>
}

/** A command: an app sends a request, the robot a response. */
export interface Command<Request, Response, Failure extends string = never> extends OperationFacts, Declares<Failure> {
  /** Always this word. */
  readonly is: 'command'
  /** Effect on the robot. */
  readonly effect: Effect
  /** Schema of the request. */
  readonly request: Struct<Request>
  /** Schema of the response. */
  readonly response: Struct<Response>
  /** The spec's example of the request. */
  readonly requestExample: () => Request
  /** The spec's example of the response. */
  readonly responseExample: () => Response
  /** Conditions under which it is accepted; absent where the spec does not specify any. */
  readonly preconditions?: Preconditions
}

/** A command that sets off reports, which can be followed to an end. */
export interface FollowedCommand<Request, Response, Body, Failure extends string = never>
  extends Command<Request, Response, Failure> {
  /** The reports that it sets off. */
  readonly setsOff: SetOff<Request, Response, Body>
}

/** The reports that a command sets off. */
export interface SetOff<Request, Response, Body> {
  /** The report. */
  readonly report: Report<Body>
  /**
   * Pairs of values that tie a report to a call. One is from the request or the response, the other from the report. An
   * empty list ties every such report.
   */
  readonly tied: readonly Tie<Request, Response, Body>[]
}

/** Two values that are equal in a call and in a report that belongs to it. */
export interface Tie<Request, Response, Body> {
  /** The value of the call. */
  call(request: Request, response: Response): unknown
  /** The value of the report. */
  report(body: Body): unknown
}

/** A report: the robot sends it, an app acknowledges it. */
export interface Report<Body, Name extends string = string> extends OperationFacts {
  /** Always this word. */
  readonly is: 'report'
  /** Its name among those of `reports()`. */
  readonly case: Name
  /** Schema of the report. */
  readonly body: Struct<Body>
  /** Schema of the acknowledgement's keys, without those of the envelope. */
  readonly acknowledgement: AnyStruct
  /** The spec's example of it. */
  readonly example: () => Body
  /** Policy for its acknowledgement; absent for the protocol's default. */
  readonly ack?: AckPolicy
  /** When the report is sent; absent where the spec does not specify it. */
  readonly cadence?: Cadence
  /** The field with the progress of a process; absent where the spec does not specify one. */
  readonly state?: StateOf<Body>
  /** Other fields that may report a failure. */
  readonly failures?: readonly StateOf<Body>[]
}

/** A report's value with the progress of a process, or with a failure. */
export interface StateOf<Body> {
  /** Its enum. */
  readonly schema: AnyEnum
  /** Returns the value; `undefined` if the report does not have it. */
  of(body: Body): number | bigint | string | undefined
}

/** A stream: one side sends frames over the data port, without responses. */
export interface Stream<Content> extends OperationFacts {
  /** Always this word. */
  readonly is: 'stream'
  /** The side that sends it. */
  readonly from: 'app' | 'robot'
  /** Schema of a frame's content; `null` for raw bytes. */
  readonly content: Content extends Uint8Array ? null : Struct<Content>
  /** The media type of raw bytes, if specified. */
  readonly mediaType?: string
  /** Name of the command after which it is sent. */
  readonly startedBy?: string
  /** Name of the command after which it is no longer sent. */
  readonly stoppedBy?: string
}

/** A command of any types. */
export interface AnyCommand extends OperationFacts {
  /** Always this word. */
  readonly is: 'command'
  /** Effect on the robot. */
  readonly effect: Effect
  /** Schema of the request. */
  readonly request: AnyStruct
  /** Schema of the response. */
  readonly response: AnyStruct
  /** The spec's example of the request. */
  readonly requestExample: () => unknown
  /** The spec's example of the response. */
  readonly responseExample: () => unknown
  /** The declared results besides success, by name. */
  readonly errors: Readonly<Record<string, ResultText>>
  /** Conditions under which it is accepted. */
  readonly preconditions?: Preconditions
}

/** A report of any type. */
export interface AnyReportOf extends OperationFacts {
  /** Always this word. */
  readonly is: 'report'
  /** Its name among those of `reports()`. */
  readonly case: string
  /** Schema of the report. */
  readonly body: AnyStruct
  /** Schema of the acknowledgement's keys, without those of the envelope. */
  readonly acknowledgement: AnyStruct
  /** The spec's example of it. */
  readonly example: () => unknown
  /** Policy for its acknowledgement. */
  readonly ack?: AckPolicy
  /** When it is sent. */
  readonly cadence?: Cadence
}

/** A stream of any content. */
export interface AnyStream extends OperationFacts {
  /** Always this word. */
  readonly is: 'stream'
  /** The side that sends it. */
  readonly from: 'app' | 'robot'
  /** Schema of a frame's content; `null` for raw bytes. */
  readonly content: AnyStruct | null
}

/** A received report. `case` is its name, `value` its content. */
export interface Reported<Name extends string, Body> extends Tagged<Name, Body> {
  /** Command code. */
  readonly code: number
  /** Message id. */
  readonly id: number
  /** Time the report was sent, in milliseconds since 1970; `null` if it carries no time. */
  readonly time: number | null
}

/** Returns `true` if the command is accepted in `state`, as far as states of this enum decide it. */
export function acceptedIn<State>(command: AnyCommand, schema: Enum<State>, state: State): boolean {
  const states = command.preconditions?.states
  if (states === undefined || states === 'any') return true
  const said = states.filter(({ of }) => (of as unknown) === schema)
  return said.every(({ values }) => (values as readonly unknown[]).includes(state))
}
