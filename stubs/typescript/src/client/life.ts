// The state of a connection, as a value and as a stream of its changes.

import { Change } from '../alarm.ts'
import type { Loss } from '../loss.ts'

/**
 * The present state of a connection, with the reason if there is none. `connects` counts the connections made so far.
 */
export type ConnectionState =
  /** There is a connection. */
  | { readonly is: 'connected'; readonly connects: number }
  /** There is no connection. The first one, or another one after a loss, is being made. */
  | { readonly is: 'connecting'; readonly connects: number; readonly why: Loss }
  /** There will be no connection any more. */
  | { readonly is: 'closed'; readonly connects: number; readonly why: Loss }

/** The state of a connection, with its watchers. */
export class Life {
  /** Fires at each change. */
  readonly changed: Change = new Change()
  private state: ConnectionState = { is: 'connecting', connects: 0, why: { is: 'not_yet' } }

  /** The present state. */
  get now(): ConnectionState {
    return this.state
  }

  /** Notes a new connection. */
  connected(): void {
    this.turn({ is: 'connected', connects: this.state.connects + 1 })
  }

  /** Notes a loss: another connection is being made. */
  lost(why: Loss): void {
    this.turn({ is: 'connecting', connects: this.state.connects, why })
  }

  /** Notes the end. The first reason counts. */
  close(why: Loss): void {
    this.turn({ is: 'closed', connects: this.state.connects, why })
  }

  private turn(state: ConnectionState): void {
    if (this.state.is === 'closed') return
    this.state = state
    this.changed.tell()
  }

  /** Yields the present state, then each change; a slow reader gets the latest. Ends after the last state. */
  async *states(): AsyncGenerator<ConnectionState, void, undefined> {
    let told: ConnectionState | null = null
    for (;;) {
      while (this.state === told) await this.changed.wait()
      told = this.state
      yield told
      if (told.is === 'closed') return
    }
  }

  /** Waits for the end. Returns the reason. */
  async closed(): Promise<Loss> {
    for (;;) {
      if (this.state.is === 'closed') return this.state.why
      await this.changed.wait()
    }
  }
}
