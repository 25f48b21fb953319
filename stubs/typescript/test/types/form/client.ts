// What is emitted as client.ts: the app's side.

import { Connection, dial, dialLater } from 'fc-protocol/runtime'
import type { CallOptions, ClientConfig, FollowableCall, Platform, Reported, UnknownReport } from 'fc-protocol/runtime'
import * as commands from './commands.ts'
import type * as messages from './messages.ts'
import { toy } from './protocol_of.ts'

/** Any report: `case` tells which. */
export type AnyReport = Reported<'DriveProgress', messages.DriveProgress> | UnknownReport

/** A robot as seen from the app: one method per command. */
export class Client extends Connection<AnyReport> {
  /** Connects to a robot; what `config` does not set has the default of the spec. */
  static async connect(platform: Platform, config: ClientConfig = {}): Promise<Client> {
    return new Client(await dial(toy, platform, config))
  }

  /** Returns at once and connects in the background; calls made meanwhile wait within their timeout. */
  static connectLazy(platform: Platform, config: ClientConfig = {}): Client {
    return new Client(dialLater(toy, platform, config))
  }

  /** Asks for the name. */
  getName(request: messages.GetNameRequest, options?: CallOptions): Promise<messages.GetNameResponse> {
    return this.call(commands.getName, request, options)
  }

  /** Drives somewhere. */
  startDrive(
    request: messages.StartDriveRequest,
    options?: CallOptions,
  ): FollowableCall<messages.StartDriveResponse, messages.DriveProgress> {
    return this.call(commands.startDrive, request, options)
  }
}
