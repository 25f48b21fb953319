package fc.bench

import java.io.File

/** Numbers of calls in flight. */
private val IN_FLIGHT = listOf(1, 64)

/** A process on its own core, if there are several. */
private class Worker(core: Int, vararg words: String) : AutoCloseable {
    private val process = ProcessBuilder(pinned(core) + JAVA + words).redirectError(ProcessBuilder.Redirect.INHERIT).start()
    private val questions = process.outputStream.bufferedWriter()
    private val answers = process.inputStream.bufferedReader()

    /** The first line of its output. */
    val first = answer()

    private fun answer() = checkNotNull(answers.readLine()) { "a process has ended" }

    /** Sends a line and waits for the reply. */
    fun ask(question: String): String {
        questions.write(question + "\n")
        questions.flush()
        return answer()
    }

    override fun close() {
        process.destroyForcibly().waitFor()
    }

    private companion object {
        val JAVA = listOf(
            File(System.getProperty("java.home"), "bin/java").path,
            "-Xmx512m",
            "-cp",
            System.getProperty("java.class.path"),
            "fc.bench.MainKt",
        )

        fun pinned(core: Int): List<String> {
            val hasCores = Runtime.getRuntime().availableProcessors() > 1 && File("/usr/bin/taskset").canExecute()
            return if (hasCores) listOf("taskset", "-c", "$core") else emptyList()
        }
    }
}

private class Round(val seconds: Double, val rate: Double, val p50: Double, val p99: Double, val cpu: Double)

/** The server and the caller process of a peer. */
private class Pair(val peer: Peer) : AutoCloseable {
    private val server = Worker(0, "serve", peer.name)
    private val caller = Worker(1, "call", peer.name, server.first)
    var calls = 0
    val rounds = ArrayList<Round>()

    /** Runs one round. Returns its time, and the CPU time of both processes. */
    fun round(inFlight: Int): Round {
        server.ask("begin")
        caller.ask("begin")
        val (seconds, p50, p99) = caller.ask("$inFlight $calls").split(' ').map { it.toDouble() }
        val cpu = caller.ask("end").toDouble() + server.ask("end").toDouble()
        return Round(seconds, calls / seconds, p50, p99, cpu / calls)
    }

    fun middle(figure: (Round) -> Double) = median(rounds.map(figure))

    override fun close() {
        caller.close()
        server.close()
    }
}

/** Returns the cost of calls for each peer and number in flight, in the format of the report. */
internal fun calls(effort: Effort): List<Map<String, Any>> {
    val pairs = ArrayList<Pair>()
    try {
        PEERS.mapTo(pairs) { Pair(it) }
        return IN_FLIGHT.map { linkedMapOf("in_flight" to it, "peers" to scenario(pairs, it, effort)) }
    } finally {
        pairs.forEach { it.close() }
    }
}

private fun scenario(pairs: List<Pair>, inFlight: Int, effort: Effort): List<Map<String, Any?>> {
    for (pair in pairs) {
        // Warms up the compiler, and doubles the calls of a round until it is long enough.
        pair.calls = 16 * inFlight
        var warmed = 0.0
        while (true) {
            val seconds = pair.round(inFlight).seconds
            warmed += seconds
            if (seconds * 1000 < effort.millis) pair.calls *= 2 else if (warmed * 1000 >= effort.warmMillis) break
        }
        pair.rounds.clear()
    }
    repeat(effort.rounds) { for (pair in pairs) pair.rounds.add(pair.round(inFlight)) }
    return pairs.map { pair ->
        // A window of a baseline is not a call, so its latency means nothing.
        val hasTimes = inFlight == 1 || !pair.peer.windows
        linkedMapOf(
            "name" to pair.peer.name,
            "rate" to pair.middle { it.rate },
            "p50" to if (hasTimes) pair.middle { it.p50 } else null,
            "p99" to if (hasTimes) pair.middle { it.p99 } else null,
            "cpu" to pair.middle { it.cpu },
        )
    }
}
