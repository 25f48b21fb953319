// Servers and callers: this package, gRPC, and the bare sockets of Node.js, with the same request and the same
// response.

import { connect, createServer } from 'node:net'
import { fileURLToPath } from 'node:url'
import grpc from '@grpc/grpc-js'
import loader from '@grpc/proto-loader'
import { Client, StationType, serve } from '../dist/generated/index.js'
import { wire } from '../dist/generated/wire.js'
import { nodePlatform } from '../dist/src/node.js'

const HOST = '127.0.0.1'
const STATION = 1_671_124_918_008
const NAME = 'gate1'
const { success } = wire.results

/** A robot that returns a station, with a new message for each call. */
class Robot {
  getStation({ data }) {
    return {
      data: {
        stationName: NAME,
        stationId: data.stationId,
        stationType: StationType.Navigation,
        x: 0.5,
        y: 0.6,
        yaw: 0.2,
      },
    }
  }
}

const fc = {
  async serve() {
    const server = await serve(nodePlatform, new Robot(), { address: HOST, commandPort: 0, dataPort: 0 })
    return server.commandPort
  },
  async connect(port) {
    const client = await Client.connect(nodePlatform, { host: HOST, commandPort: port })
    const stationId = BigInt(STATION)
    return async () => {
      const { data } = await client.getStation({ data: { stationId } })
      if (data.stationId !== stationId || data.stationName !== NAME) throw new Error('another answer')
    }
  },
}

const proto = fileURLToPath(new URL('../../../bench/proto/bench.proto', import.meta.url))
const bench = () => grpc.loadPackageDefinition(loader.loadSync(proto)).bench

const grpcJs = {
  serve() {
    const server = new grpc.Server()
    server.addService(bench().Robot.service, {
      getStation({ request }, answer) {
        answer(null, {
          cmdTime: Date.now(),
          resultCode: success.code,
          resultMsg: success.text,
          stationName: NAME,
          stationId: request.stationId,
          stationType: StationType.Navigation,
          x: 0.5,
          y: 0.6,
          yaw: 0.2,
        })
      },
    })
    return new Promise((resolve, reject) => {
      server.bindAsync(`${HOST}:0`, grpc.ServerCredentials.createInsecure(), (problem, port) => {
        if (problem) reject(problem)
        else resolve(port)
      })
    })
  },
  async connect(port) {
    const client = new (bench().Robot)(`${HOST}:${port}`, grpc.credentials.createInsecure())
    return () =>
      new Promise((resolve, reject) => {
        client.getStation({ cmdTime: Date.now(), stationId: STATION }, (problem, answer) => {
          if (problem) reject(problem)
          else if (Number(answer.stationId) !== STATION || answer.stationName !== NAME)
            reject(new Error('another answer'))
          else resolve()
        })
      })
  },
}

/** Bytes of the request's frame, and of the response's. */
const ASKS = 95
const ANSWERS = 204

/** The floor: as many bytes, a window of requests in one write, without any processing. */
const raw = {
  serve() {
    const answers = Buffer.alloc(64 * ANSWERS, 1)
    const server = createServer({ noDelay: true }, (socket) => {
      let held = 0
      socket.on('data', ({ length }) => {
        held += length
        const whole = Math.floor(held / ASKS)
        held -= whole * ASKS
        if (whole > 0) socket.write(answers.subarray(0, whole * ANSWERS))
      })
    })
    return new Promise((resolve) => {
      server.listen(0, HOST, () => resolve(server.address().port))
    })
  },
  connect(port, window) {
    const asks = Buffer.alloc(window * ASKS, 1)
    let missing = 0
    let done
    const socket = connect({ host: HOST, port, noDelay: true })
    socket.on('data', ({ length }) => {
      missing -= length
      if (missing === 0) done()
    })
    const call = () =>
      new Promise((resolve) => {
        done = resolve
        missing = window * ANSWERS
        socket.write(asks)
      })
    return new Promise((resolve) => {
      socket.once('connect', () => resolve(call))
    })
  },
}

/**
 * All peers. Each serves on a port and connects to one. The connection makes one call, or a window of them with
 * `windows`.
 */
export const peers = { raw: { ...raw, windows: true }, fc, 'grpc-js': grpcJs }
