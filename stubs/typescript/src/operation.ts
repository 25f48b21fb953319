// Commands, reports and streams as values that know their types. A package has one constant for each.

import type { Text } from './protocol.ts'
import type { AnyEnum, AnyStruct, Enum, Struct, Tagged } from './schema.ts'
import type { AckPolicy } from './session.ts'

/** What a command does to the robot. */
export type Effect =
  /** Only asks. */
  | 'read'
  /** Changes what the robot knows or how it behaves. */
  | 'config'
  /** Sets something in motion. */
  | 'motion'
  /** Nobody knows: never repeated by itself, like what sets something in motion. */
  | 'unknown'

/** A result code and the text sent beside it. */
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

/** What has to hold before a command is accepted. */
export interface Preconditions {
  /** In which states: `any`, or those in which each of these enums has one of these values. Absent where nothing is said. */
  readonly states?: 'any' | readonly States[]
  /** Names of the commands that come first. */
  readonly after: readonly string[]
}

/** When a report is sent. A path is that of wire keys from the report's body on, joined by dots. */
export type Cadence =
  /** At each change of a field. */
  | { readonly is: 'on_change'; readonly field: string }
  /** At each step of a number. */
  | { readonly is: 'step'; readonly field: string; readonly by: number }
  /** At intervals of so many milliseconds. */
  | { readonly is: 'every'; readonly ms: number }
  /** At the latest so many milliseconds after a command that sets it off. */
  | { readonly is: 'within'; readonly ms: number }

/** What every operation says of itself. */
export interface OperationFacts {
  /** Name in the spec. */
  readonly name: string
  /** Command code; `null` while the spec has not given one: such an operation cannot be sent. */
  readonly code: number | null
  /** Title in both languages. */
  readonly title: Text
  /** First version of the spec that has it, as `YYYY-MM` or `YYYY-MM-DD`. */
  readonly since?: string
  /** Whether it has been withdrawn. */
  readonly deprecated?: boolean
  /** Path of its page below the documentation's root. */
  readonly docs: string
  /** File of the spec that defines it. */
  readonly spec: string
}

/** What declares results besides success. */
export interface Declares<Failure extends string> {
  /** The results besides success that it declares, by their names. */
  readonly errors: Readonly<Record<Failure, ResultText>>
}

/** A command: an app asks, the robot answers. */
export interface Command<Request, Response, Failure extends string = never> extends OperationFacts, Declares<Failure> {
  /** Always this word. */
  readonly is: 'command'
  /** What it does to the robot. */
  readonly effect: Effect
  /** What it asks. */
  readonly request: Struct<Request>
  /** What it is answered with. */
  readonly response: Struct<Response>
  /** The spec's example of the request. */
  readonly requestExample: () => Request
  /** The spec's example of the response. */
  readonly responseExample: () => Response
  /** What has to hold before it is accepted; absent where the spec says nothing of that. */
  readonly preconditions?: Preconditions
}

/** A command that sets off reports which can be followed to an end. */
export interface FollowedCommand<Request, Response, Body, Failure extends string = never>
  extends Command<Request, Response, Failure> {
  /** What it sets off. */
  readonly setsOff: SetOff<Request, Response, Body>
}

/** What a command sets off. */
export interface SetOff<Request, Response, Body> {
  /** The report. */
  readonly report: Report<Body>
  /** What ties a report to a call: values of its request or its answer, and of the report. None: any such report belongs. */
  readonly tied: readonly Tie<Request, Response, Body>[]
}

/** Two values that are the same in a call and in a report that belongs to it. */
export interface Tie<Request, Response, Body> {
  /** That of the call. */
  call(request: Request, response: Response): unknown
  /** That of the report. */
  report(body: Body): unknown
}

/** A report: the robot says, an app acknowledges. */
export interface Report<Body, Name extends string = string> extends OperationFacts {
  /** Always this word. */
  readonly is: 'report'
  /** Its name among those of `reports()`. */
  readonly case: Name
  /** What it says. */
  readonly body: Struct<Body>
  /** The keys of its acknowledgement beside those of the envelope. */
  readonly acknowledgement: AnyStruct
  /** The spec's example of it. */
  readonly example: () => Body
  /** How its acknowledgement is awaited; absent for the protocol's default. */
  readonly ack?: AckPolicy
  /** When it is sent; absent where the spec says nothing of that. */
  readonly cadence?: Cadence
  /** What says how far a process has come; absent where the spec says nothing of that. */
  readonly state?: StateOf<Body>
  /** What else may say that something failed. */
  readonly failures?: readonly StateOf<Body>[]
}

/** The value of a report that says how far a process has come, or that something failed. */
export interface StateOf<Body> {
  /** Its enum. */
  readonly schema: AnyEnum
  /** Takes it from a report; `undefined` if the report does not say. */
  of(body: Body): number | bigint | string | undefined
}

/** A stream: one side sends frames over the data port, nobody answers. */
export interface Stream<Content> extends OperationFacts {
  /** Always this word. */
  readonly is: 'stream'
  /** Which side sends it. */
  readonly from: 'app' | 'robot'
  /** What a frame carries; `null` for raw bytes. */
  readonly content: Content extends Uint8Array ? null : Struct<Content>
  /** The media type of raw bytes, where one is stated. */
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
  /** What it does to the robot. */
  readonly effect: Effect
  /** What it asks. */
  readonly request: AnyStruct
  /** What it is answered with. */
  readonly response: AnyStruct
  /** The spec's example of the request. */
  readonly requestExample: () => unknown
  /** The spec's example of the response. */
  readonly responseExample: () => unknown
  /** The results besides success that it declares. */
  readonly errors: Readonly<Record<string, ResultText>>
  /** What has to hold before it is accepted. */
  readonly preconditions?: Preconditions
}

/** A report of any type. */
export interface AnyReportOf extends OperationFacts {
  /** Always this word. */
  readonly is: 'report'
  /** Its name among those of `reports()`. */
  readonly case: string
  /** What it says. */
  readonly body: AnyStruct
  /** The keys of its acknowledgement beside those of the envelope. */
  readonly acknowledgement: AnyStruct
  /** The spec's example of it. */
  readonly example: () => unknown
  /** How its acknowledgement is awaited. */
  readonly ack?: AckPolicy
  /** When it is sent. */
  readonly cadence?: Cadence
}

/** A stream of any content. */
export interface AnyStream extends OperationFacts {
  /** Always this word. */
  readonly is: 'stream'
  /** Which side sends it. */
  readonly from: 'app' | 'robot'
  /** What a frame carries; `null` for raw bytes. */
  readonly content: AnyStruct | null
}

/** A report that has arrived, by its name: `case` tells which, `value` is what it says. */
export interface Reported<Name extends string, Body> extends Tagged<Name, Body> {
  /** Command code. */
  readonly code: number
  /** Message id. */
  readonly id: number
  /** When it was sent, in milliseconds since 1970, if it says so. */
  readonly time: number | null
}

/** Whether a command is accepted in a state, as far as it depends on states of this enum. */
export function acceptedIn<State>(command: AnyCommand, schema: Enum<State>, state: State): boolean {
  const states = command.preconditions?.states
  if (states === undefined || states === 'any') return true
  const said = states.filter(({ of }) => (of as unknown) === schema)
  return said.every(({ values }) => (values as readonly unknown[]).includes(state))
}
