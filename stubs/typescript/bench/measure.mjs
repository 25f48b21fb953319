// Work on one thread, in CPU time of this process, garbage collection included.

/** Returns the median. */
export function median(values) {
  const sorted = [...values].sort((a, b) => a - b)
  return sorted[sorted.length >> 1] ?? Number.NaN
}

/** Returns the figures in random order. */
function shuffled(values) {
  const mixed = [...values]
  for (let index = mixed.length - 1; index > 0; index--) {
    const other = Math.floor(Math.random() * (index + 1))
    ;[mixed[index], mixed[other]] = [mixed[other], mixed[index]]
  }
  return mixed
}

/** Returns the CPU time of `times` runs, in microseconds. */
function cost(run, times) {
  const before = process.cpuUsage()
  for (let count = 0; count < times; count++) run()
  const { user, system } = process.cpuUsage(before)
  return user + system
}

/**
 * Returns the time of each case in microseconds, the median of its rounds. The cases take turns, in another order each
 * round. A disturbance then affects all of them alike.
 */
export function measure(cases, { rounds, batch }) {
  const names = Object.keys(cases)
  const times = {}
  const found = {}
  for (const name of names) {
    times[name] = 1
    found[name] = []
    // Repeats until the case is compiled and takes as long as a batch should.
    while (cost(cases[name], times[name]) < batch * 1000) times[name] *= 2
  }
  for (let round = 0; round < rounds; round++) {
    for (const name of shuffled(names)) found[name].push(cost(cases[name], times[name]) / times[name])
  }
  return Object.fromEntries(names.map((name) => [name, median(found[name])]))
}
