package fc.bench

import com.sun.management.OperatingSystemMXBean
import java.lang.management.ManagementFactory
import java.util.concurrent.atomic.AtomicInteger
import kotlinx.coroutines.Dispatchers
import kotlinx.coroutines.coroutineScope
import kotlinx.coroutines.launch
import kotlinx.coroutines.runBlocking

private val system = ManagementFactory.getOperatingSystemMXBean() as OperatingSystemMXBean

/** CPU time of this process so far, including garbage collector and compiler, in microseconds. */
private fun cpu(): Double = system.processCpuTime / 1000.0

/** Serves a peer and prints its port. Then prints the CPU time between `begin` and `end`. */
internal fun serve(peer: Peer): Unit = obey(peer.serve().toString()) { it }

/**
 * Calls a peer at a port. Each input line has the calls in flight and the number of calls. The reply has the seconds of
 * the round, and the median and 99th percentile of a call in microseconds.
 */
internal fun call(peer: Peer, port: Int) {
    // One connection for all, or one per window size.
    val connections = HashMap<Int, suspend () -> Unit>()
    obey("ready") { line ->
        val (inFlight, calls) = line.split(' ').map { it.toInt() }
        val window = if (peer.windows) inFlight else 1
        val call = connections.getOrPut(window) { runBlocking { peer.connect(port, window) } }
        drive(call, inFlight / window, (calls + window - 1) / window)
    }
}

private fun obey(first: String, other: (String) -> String) {
    println(first)
    var begun = 0.0
    for (line in generateSequence { readlnOrNull() }) {
        val answer = when (line) {
            "begin" -> "begun".also { begun = cpu() }
            "end" -> (cpu() - begun).toString()
            else -> other(line)
        }
        println(answer)
    }
}

/** Makes [calls] calls with [inFlight] in flight. */
private fun drive(call: suspend () -> Unit, inFlight: Int, calls: Int): String {
    val times = LongArray(calls)
    val begun = AtomicInteger()
    val start = System.nanoTime()
    runBlocking(Dispatchers.Default) {
        coroutineScope {
            repeat(inFlight) {
                launch {
                    while (true) {
                        val index = begun.getAndIncrement()
                        if (index >= calls) break
                        val from = System.nanoTime()
                        call()
                        times[index] = System.nanoTime() - from
                    }
                }
            }
        }
    }
    val seconds = (System.nanoTime() - start) / 1e9
    times.sort()
    fun at(share: Double) = times[((calls - 1) * share).toInt()] / 1e3
    return "$seconds ${at(0.5)} ${at(0.99)}"
}
