// A result other than success, sent by a handler or received from a peer.

import type { Declares, ResultText } from './operation.ts'

/** A refusal, with its result code. A handler throws it. */
export class Refusal extends Error {
  /** Result code; not the one of success. */
  readonly code: number
  /** Text for people. Never rely on it. */
  readonly text: string

  /** Creates a refusal with this result code and text. */
  constructor(code: number, text: string) {
    super(`${code} ${text}`.trim())
    this.name = 'Refusal'
    this.code = code
    this.text = text
  }

  /** Returns the refusal for a result. */
  static of({ code, text }: ResultText): Refusal {
    return new Refusal(code, text)
  }

  /** Returns the refusal for an error that a command declares. */
  static declared<Failure extends string>(command: Declares<Failure>, failure: NoInfer<Failure>): Refusal {
    return Refusal.of(command.errors[failure])
  }

  /** Returns the name of the command's declared error; `null` for any other result. */
  declared<Failure extends string>(command: Declares<Failure>): Failure | null {
    for (const [name, { code }] of Object.entries<ResultText>(command.errors)) {
      if (code === this.code) return name as Failure
    }
    return null
  }
}
