// The form of the generated client.ts: the app's side.

import { Connection, addAppStreams, addCalls, dial, dialLater } from 'fc-protocol/runtime'
import type { ClientConfig, DataConnection, Platform, UnknownReport } from 'fc-protocol/runtime'
import type * as messages from './messages.ts'
import { service, streams, toy } from './protocol_of.ts'

/** Any report: `case` tells which. */
export type AnyReport = messages.DriveReport | UnknownReport

/** The methods of each group of commands. */
export interface Client extends messages.DriveCalls {}

/** A robot as seen from the app: one method per command. */
export class Client extends Connection<AnyReport> {
  static {
    addCalls(Client, service.methods)
  }

  /** Connects to a robot. Settings absent from `config` have the spec's defaults. */
  static async connect(platform: Platform, config: ClientConfig = {}): Promise<Client> {
    return new Client(await dial(toy, platform, config))
  }

  /** Returns at once and connects in the background; calls made meanwhile wait within their timeout. */
  static connectLazy(platform: Platform, config: ClientConfig = {}): Client {
    return new Client(dialLater(toy, platform, config))
  }
}

/** The methods of each group of streams. */
export interface Streams extends messages.DriveStreams {}

/** The streams of the data port. */
export class Streams {
  static {
    addAppStreams(Streams, streams)
  }

  /** The data connection. */
  protected readonly data: DataConnection

  /** Creates the streams of a data connection. */
  constructor(data: DataConnection) {
    this.data = data
  }
}
