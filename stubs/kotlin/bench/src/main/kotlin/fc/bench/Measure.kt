package fc.bench

import java.lang.management.ManagementFactory

/** How long to measure: [rounds] of all cases, each of at least so many milliseconds, after some until all is compiled. */
internal class Effort(val rounds: Int, val millis: Long, val warmMillis: Long)

/** The middle of some figures. */
internal fun median(figures: List<Double>): Double = figures.sorted()[figures.size / 2]

private val threads = ManagementFactory.getThreadMXBean()

/** Microseconds of this thread's CPU time that so many runs take. */
private fun cost(times: Int, run: () -> Unit): Double {
    val before = threads.currentThreadCpuTime
    repeat(times) { run() }
    return (threads.currentThreadCpuTime - before) / 1000.0
}

/**
 * Microseconds that each of some cases takes, the median of its rounds. The cases take turns, in another order each round, so
 * that what disturbs one disturbs all.
 */
internal fun measure(cases: List<() -> Unit>, effort: Effort): List<Double> {
    val times = cases.map { run ->
        var warmed = 0.0
        while (warmed < effort.warmMillis * 1000) warmed += cost(1, run)
        var times = 1
        while (cost(times, run) < effort.millis * 1000) times *= 2
        times
    }
    val found = cases.map { ArrayList<Double>() }
    repeat(effort.rounds) {
        for (at in cases.indices.shuffled()) found[at].add(cost(times[at], cases[at]) / times[at])
    }
    return found.map { median(it) }
}
