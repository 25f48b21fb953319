package fc.bench

import java.lang.management.ManagementFactory

/** The length of a measurement: [rounds] over all cases, [millis] for each, after [warmMillis] for the compiler. */
internal class Effort(val rounds: Int, val millis: Long, val warmMillis: Long)

/** Returns the median. */
internal fun median(figures: List<Double>): Double = figures.sorted()[figures.size / 2]

private val threads = ManagementFactory.getThreadMXBean()

/** Returns the CPU time of this thread for a number of runs, in microseconds. */
private fun cost(times: Int, run: () -> Unit): Double {
    val before = threads.currentThreadCpuTime
    repeat(times) { run() }
    return (threads.currentThreadCpuTime - before) / 1000.0
}

/**
 * Returns the time of each case in microseconds, the median of its rounds. Each round runs the cases in another order,
 * so that a disturbance affects them all.
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
