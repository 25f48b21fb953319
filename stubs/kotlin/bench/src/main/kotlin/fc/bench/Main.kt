package fc.bench

import com.google.gson.GsonBuilder
import com.google.gson.JsonElement
import com.google.gson.JsonObject
import com.google.gson.internal.GsonBuildConfig
import java.io.File
import java.time.LocalDate
import java.time.ZoneOffset
import kotlin.system.exitProcess

private const val USAGE = """usage: bench/run [--smoke | --report]

--smoke   one tiny round: that all of it works, and no figures to go by
--report  writes bench/packages/kotlin.json, which the page about performance shows"""

/**
 * Compares the package with plain JSON and MD5, and with blocking sockets. Also runs the server and caller processes.
 */
public fun main(arguments: Array<String>) {
    val words = arguments.toList()
    when (words.firstOrNull()) {
        "serve" -> serve(peer(words[1]))
        "call" -> call(peer(words[1]), words[2].toInt())
        else -> measure(File(words[0]), words.drop(1))
    }
    exitProcess(0)
}

private fun peer(name: String) = PEERS.first { it.name == name }

private fun measure(bench: File, options: List<String>) {
    val isSmoke = options == listOf("--smoke")
    val isReport = options == listOf("--report")
    if (options.isNotEmpty() && !isSmoke && !isReport) {
        System.err.println(USAGE)
        exitProcess(2)
    }
    val report = linkedMapOf(
        "language" to "Kotlin",
        "date" to LocalDate.now(ZoneOffset.UTC).toString(),
        "processor" to processor(),
        "cores" to Runtime.getRuntime().availableProcessors(),
        "versions" to linkedMapOf(
            "Kotlin" to KotlinVersion.CURRENT.toString(),
            "Java" to System.getProperty("java.version"),
            "Gson" to GsonBuildConfig.VERSION,
        ),
        "json" to "Gson",
        "grpc" to COMPARED,
        "goals" to mapOf("calls" to 0.5),
        "codec" to codec(bench, if (isSmoke) Effort(1, 1, 1) else Effort(31, 20, 2000)),
        "calls" to calls(if (isSmoke) Effort(1, 10, 10) else Effort(9, 400, 4000)),
    )
    val gson = GsonBuilder().setPrettyPrinting().serializeNulls().disableHtmlEscaping().create()
    val tree = gson.toJsonTree(report).asJsonObject
    show(tree)
    if (isReport) File(bench, "packages/kotlin.json").writeText(gson.toJson(tree) + "\n")
}

/** Returns the name of the processor, if the system knows it. */
private fun processor(): String {
    val file = File("/proc/cpuinfo")
    val line = if (file.canRead()) file.useLines { lines -> lines.firstOrNull { it.startsWith("model name") } } else null
    return line?.substringAfter(": ") ?: System.getProperty("os.arch")
}

/** Prints the tables. */
private fun show(report: JsonObject) {
    println("Times in microseconds. Floor: JSON and MD5 alone, on the same bytes.\n")
    println(" ".repeat(16) + "     floor        fc  / floor  messages/s".repeat(2))
    for (one in report["codec"].asJsonArray.map { it.asJsonObject }) {
        print("%-8s%8d".format(one["message"].asString, one["bytes"].asInt))
        for (what in listOf("decode", "encode")) {
            val (least, fc) = listOf("least", "fc").map { one[what].asJsonObject[it].asDouble }
            print("%10.2f%10.2f%9.2f%,12d".format(least, fc, fc / least, (1e6 / fc).toLong()))
        }
        println()
    }
    println("(first decoded, then encoded)")
    for (scenario in report["calls"].asJsonArray.map { it.asJsonObject }) {
        val peers = scenario["peers"].asJsonArray.map { it.asJsonObject }
        val compared = peers.first { it["name"].asString == COMPARED }
        println("\nCalls, ${scenario["in_flight"]} in flight")
        println("%-10s%12s%13s%10s%10s%10s".format("", "calls/s", "/ $COMPARED", "p50", "p99", "CPU/call"))
        for (peer in peers) {
            val rate = peer["rate"].asDouble
            print("%-10s%,12d%13.2f".format(peer["name"].asString, rate.toLong(), rate / compared["rate"].asDouble))
            println("%10s%10s%10.2f".format(digits(peer["p50"]), digits(peer["p99"]), peer["cpu"].asDouble))
        }
    }
}

private fun digits(time: JsonElement): String = if (time.isJsonNull) "-" else "%.0f".format(time.asDouble)
