// A robot for trying out an app. It responds to every command with the spec's example, even to those that move a real
// robot. It pushes every report once to each app. If an app requests the picture of a map, it sends one over the data
// port.

import { ExampleRobot, Fc, PushError, commands, serve } from 'fc-protocol'
import type { Context, Robot, Server } from 'fc-protocol'
import { nodePlatform } from 'fc-protocol/node'
import { setTimeout as sleep } from 'node:timers/promises'
import { main, ports } from './support.ts'

/** Time for requests in handlers when the robot is asked to end, in milliseconds. */
const GRACE = 5000

const USAGE = `Responds to every command with the example in the spec. Nothing moves: this is for trying out apps.

Usage: robot [--host 127.0.0.1] [--command-port PORT] [--data-port PORT] [--once]
             [--delay MILLISECONDS] [--gzip-from BYTES] [--picture-scale N]

Without ports, those of the spec; 0 for any that is free. The first line says which:
commands 127.0.0.1:PORT data 127.0.0.1:PORT
With --once the robot ends when its app has left, otherwise with Ctrl-C or SIGTERM:
what it has begun is answered first. With --delay it takes so long over each command; with
--gzip-from it compresses whatever has so many bytes; with --picture-scale the picture of a
map is so many times as wide and high.
FC_LOG=1 shows on stderr what happens.`

await main(USAGE, async (args) => {
  const bytes = picture(args.pictureScale)
  const known = new Set<number>()
  let server: Server | null = null
  const robot = attentive(args.delay, (context) => {
    if (!server) return
    if (!known.has(context.connection)) {
      known.add(context.connection)
      void pushAll(server, context.connection)
    }
    if (context.code === commands.getMapImage.code) void sendPicture(server, context, bytes)
  })
  server = await serve(nodePlatform, robot, {
    address: args.host,
    gzip: args.gzip,
    ...ports(args),
    ...(process.env['FC_LOG']
      ? {
          log: (level, message, fields) => {
            console.error(level, message, fields)
          },
        }
      : {}),
  })
  console.log(`commands ${args.host}:${server.commandPort} data ${args.host}:${server.dataPort}`)
  // #region stop
  const asked = new Promise<void>((resolve) => {
    process.once('SIGINT', () => {
      resolve()
    })
    process.once('SIGTERM', () => {
      resolve()
    })
  })
  await (args.once ? Promise.race([asked, lastLeft(server, known)]) : asked)
  // A second signal ends the robot at once.
  process.once('SIGINT', () => void server.close())
  process.once('SIGTERM', () => void server.close())
  await server.shutdown(GRACE)
  // #endregion stop
  process.exit()
})

/** Responds with the examples, and calls back with each request. There is no motion. */
function attentive(delay: number, asked: (context: Context) => void): Robot {
  return new Proxy(new ExampleRobot({ pretendMotion: true }), {
    get(robot, name) {
      const method: unknown = Reflect.get(robot, name)
      if (typeof method !== 'function') return method
      return (request: unknown, context: Context): unknown => {
        asked(context)
        const answer = (): unknown => method.call(robot, request, context)
        return delay === 0 ? answer() : sleep(delay).then(answer)
      }
    },
  })
}

/** Resolves when the last app has left. */
async function lastLeft(server: Server, known: ReadonlySet<number>): Promise<void> {
  while (known.size === 0 || server.connections().length > 0) await sleep(100)
}

/** Pushes every report with the spec's example. */
async function pushAll(server: Server, app: number): Promise<void> {
  for (const report of Fc.reports) {
    try {
      for (const { connection, outcome } of await server.pushAny(app, report, report.example())) {
        console.log(`${report.name} to ${connection}: ${outcome}`)
      }
    } catch (problem) {
      if (!(problem instanceof PushError)) throw problem
      console.log(`${report.name}: ${problem.message}`)
    }
  }
}

/** Sends a picture to the app that requested one, under the id of its request. */
async function sendPicture(server: Server, { connection, code, id }: Context, bytes: Uint8Array): Promise<void> {
  for (let tries = 0; tries < 40; tries++) {
    try {
      await server.sendBytes(connection, code, id, bytes)
      console.log(`picture of ${bytes.length} bytes to ${connection}`)
      return
    } catch (problem) {
      if (!(problem instanceof PushError)) throw problem
      if (problem.kind !== 'no_connection') {
        console.log(`picture: ${problem.message}`)
        return
      }
      // The app's request may come before its data connection has been accepted.
      await sleep(50)
    }
  }
  console.log(`picture: ${connection} has no data connection`)
}

/** A small map as a portable graymap: a room with a wall around it. */
function picture(scale: number): Uint8Array {
  const [columns, rows] = [64 * scale, 48 * scale]
  const head = new TextEncoder().encode(`P5 ${columns} ${rows} 255\n`)
  const bytes = new Uint8Array(head.length + columns * rows)
  bytes.set(head)
  for (let y = 1; y < rows - 1; y++) {
    const row = head.length + y * columns
    bytes.fill(254, row + 1, row + columns - 1)
  }
  return bytes
}
