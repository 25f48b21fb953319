// Whether there is a connection: as a value, and as a stream of its changes.

import { Change } from '../alarm.ts'
import type { Loss } from '../loss.ts'

/** Whether there is a connection at this moment, and why not. `connects` counts the connections made so far. */
export type ConnectionState =
  /** There is a connection. */
  | { readonly is: 'connected'; readonly connects: number }
  /** There is none, and one is being made: the first, or another one after a loss. */
  | { readonly is: 'connecting'; readonly connects: number; readonly why: Loss }
  /** There will be none any more. */
  | { readonly is: 'closed'; readonly connects: number; readonly why: Loss }

/** The state of a connection, and all who watch it. */
export class Life {
  /** Told at each change. */
  readonly changed: Change = new Change()
  private state: ConnectionState = { is: 'connecting', connects: 0, why: { is: 'not_yet' } }

  /** The present state. */
  get now(): ConnectionState {
    return this.state
  }

  /** There is one more connection. */
  connected(): void {
    this.turn({ is: 'connected', connects: this.state.connects + 1 })
  }

  /** There is no connection, and another one is being made. */
  lost(why: Loss): void {
    this.turn({ is: 'connecting', connects: this.state.connects, why })
  }

  /** There will be none. The first reason counts. */
  close(why: Loss): void {
    this.turn({ is: 'closed', connects: this.state.connects, why })
  }

  private turn(state: ConnectionState): void {
    if (this.state.is === 'closed') return
    this.state = state
    this.changed.tell()
  }

  /** The present state, and then each that it comes to; who is slow gets the latest. Nothing after the end. */
  async *states(): AsyncGenerator<ConnectionState, void, undefined> {
    let told: ConnectionState | null = null
    for (;;) {
      while (this.state === told) await this.changed.wait()
      told = this.state
      yield told
      if (told.is === 'closed') return
    }
  }

  /** Waits for the end, and says why. */
  async closed(): Promise<Loss> {
    for (;;) {
      if (this.state.is === 'closed') return this.state.why
      await this.changed.wait()
    }
  }
}
