// An app's connection to the data port.

import type { Stream } from '../operation.ts'

/** A frame of a stream, read. */
export interface StreamItem<Content> {
  /** Message id, that of the request which it belongs to. */
  readonly id: number
  /** What it carries. */
  readonly content: Content
}

/** The frames of one stream. */
export interface Subscription<Content> extends AsyncIterableIterator<StreamItem<Content>> {
  /** How many frames have made way for later ones since this was last asked. */
  missed(): number
  /** Takes no more. */
  close(): void
}

/** A connection to a robot's data port. */
export class DataConnection {
  /** The frames of one stream from now on. */
  subscribe<Content>(stream: Stream<Content>): Subscription<Content> {
    throw new Error(stream.name)
  }

  /** Sends a frame of a stream. */
  sendStream<Content>(stream: Stream<Content>, id: number, content: Content): Promise<void> {
    throw new Error(`${stream.name} ${id} ${String(content)}`)
  }
}
