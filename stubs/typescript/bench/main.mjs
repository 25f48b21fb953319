// Compares the package with JSON and MD5 alone, and with gRPC: `main.mjs [--smoke | --report]`.

import { readFileSync, writeFileSync } from 'node:fs'
import { availableParallelism, cpus } from 'node:os'
import { calls } from './calls.mjs'
import { codec } from './codec.mjs'

const USAGE = `usage: bench/run [--smoke | --report]

--smoke   one tiny round: that all of it works, and no figures to go by
--report  writes bench/packages/typescript.json, which the page about performance shows
`

const options = new Set(process.argv.slice(2))
if (options.size > 1 || [...options].some((option) => option !== '--smoke' && option !== '--report')) {
  process.stderr.write(USAGE)
  process.exit(2)
}
const smoke = options.has('--smoke')

const versionOf = (name) => JSON.parse(readFileSync(new URL('package.json', import.meta.url))).dependencies[name]

const report = {
  language: 'TypeScript',
  date: new Date().toISOString().slice(0, 10),
  processor: cpus()[0]?.model ?? process.arch,
  cores: availableParallelism(),
  versions: {
    'Node.js': process.versions.node,
    '@grpc/grpc-js': versionOf('@grpc/grpc-js'),
    '@grpc/proto-loader': versionOf('@grpc/proto-loader'),
  },
  json: 'JSON.parse, JSON.stringify',
  grpc: 'grpc-js',
  goals: { codec: 1.5, calls: 2 },
  codec: codec(smoke ? { rounds: 1, batch: 1 } : { rounds: 31, batch: 10 }),
  calls: await calls(smoke ? { rounds: 1, seconds: 0.01 } : { rounds: 9, seconds: 0.2 }),
}

const digits = (value) => (value === null ? '–' : Number(value.toFixed(value < 100 ? 2 : 0)))
console.log('Times in microseconds. Floor: JSON and MD5 alone, on the same bytes.')
console.table(
  report.codec.map(({ message, bytes, decode, encode }) => ({
    message,
    bytes,
    'floor, decode': digits(decode.least),
    'fc, decode': digits(decode.fc),
    '× floor': digits(decode.fc / decode.least),
    'decoded/s': Math.round(1e6 / decode.fc),
    'floor, encode': digits(encode.least),
    'fc, encode': digits(encode.fc),
    '× floor ': digits(encode.fc / encode.least),
    'encoded/s': Math.round(1e6 / encode.fc),
  })),
)
for (const { in_flight: inFlight, peers } of report.calls) {
  const grpc = peers.find(({ name }) => name === report.grpc)
  console.log(`Calls, ${inFlight} in flight`)
  console.table(
    peers.map(({ name, rate, p50, p99, cpu }) => ({
      name,
      'calls/s': Math.round(rate),
      [`× ${report.grpc}`]: digits(rate / grpc.rate),
      p50: digits(p50),
      p99: digits(p99),
      'CPU/call': digits(cpu),
      [`CPU × ${report.grpc}`]: digits(cpu / grpc.cpu),
    })),
  )
}
if (options.has('--report')) {
  const path = new URL('../../../bench/packages/typescript.json', import.meta.url)
  writeFileSync(path, `${JSON.stringify(report, null, 2)}\n`)
}
