// Work on one thread, in CPU time of this process, the collector's included.

/** The middle of some figures. */
export function median(values) {
  const sorted = [...values].sort((a, b) => a - b)
  return sorted[sorted.length >> 1] ?? Number.NaN
}

/** The same figures in another order. */
function shuffled(values) {
  const mixed = [...values]
  for (let index = mixed.length - 1; index > 0; index--) {
    const other = Math.floor(Math.random() * (index + 1))
    ;[mixed[index], mixed[other]] = [mixed[other], mixed[index]]
  }
  return mixed
}

/** Microseconds of CPU that `times` runs take. */
function cost(run, times) {
  const before = process.cpuUsage()
  for (let count = 0; count < times; count++) run()
  const { user, system } = process.cpuUsage(before)
  return user + system
}

/**
 * Microseconds that each of some cases takes, the median of its rounds. The cases take turns, in another order each round,
 * so that what disturbs one disturbs all.
 */
export function measure(cases, { rounds, batch }) {
  const names = Object.keys(cases)
  const times = {}
  const found = {}
  for (const name of names) {
    times[name] = 1
    found[name] = []
    // Until it is compiled and takes as long as a batch should.
    while (cost(cases[name], times[name]) < batch * 1000) times[name] *= 2
  }
  for (let round = 0; round < rounds; round++) {
    for (const name of shuffled(names)) found[name].push(cost(cases[name], times[name]) / times[name])
  }
  return Object.fromEntries(names.map((name) => [name, median(found[name])]))
}
