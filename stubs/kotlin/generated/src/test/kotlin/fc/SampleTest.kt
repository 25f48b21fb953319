package fc.runtime

import fc.Client
import fc.Fc
import fc.SampleRobot
import fc.runSamples
import fc.service
import java.io.ByteArrayOutputStream
import java.io.PrintStream
import kotlinx.coroutines.runBlocking
import kotlinx.coroutines.withTimeout

private const val HOST = "127.0.0.1"

/** The samples of the documentation do as they say: every command is called, every report pushed and taken. */
internal fun sampleTests(tests: Tests): Unit = tests.case("every sample runs") {
    val lines = printed {
        val config = ServerConfig().address(HOST).commandPort(0).dataPort(0)
        Server.bind(Fc, SampleRobot().service(), config).use { server ->
            val ports = ClientConfig().host(HOST).commandPort(server.commandAddress.port).dataPort(server.dataAddress.port)
            runBlocking { withTimeout(60_000) { runSamples(Client.connect(ports), server) } }
        }
    }
    val (commands, reports) = Fc.commands.size to Fc.reports.size
    expect(commands, lines.count { " asks: " in it }) { "commands asked" }
    expect(reports, lines.count { it.endsWith(": ${AckOutcome.ACKNOWLEDGED}") }) { "reports acknowledged" }
    expect(2 * (commands + reports), lines.size) { "lines" }
}

/** What is printed meanwhile, by line. */
private fun printed(body: () -> Unit): List<String> {
    val usual = System.out
    val bytes = ByteArrayOutputStream()
    System.setOut(PrintStream(bytes, true, "UTF-8"))
    try {
        body()
    } finally {
        System.setOut(usual)
    }
    return bytes.toString("UTF-8").trimEnd().lines()
}
