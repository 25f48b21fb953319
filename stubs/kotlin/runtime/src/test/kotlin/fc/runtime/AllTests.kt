package fc.runtime

import handlers.handlerTests
import java.io.File

/** Runs all tests. The first argument is the root of the project, the others select suites. */
internal fun main(arguments: Array<String>) {
    val tests = Tests(File(arguments[0]))
    val suites = listOf(
        Triple("json", 15, ::jsonTests),
        Triple("bodies.json", 239, ::bodyTests),
        Triple("messages", 60, ::messageTests),
        Triple("errors.json", 3, ::nameTests),
        Triple("frames of the vectors", 1800, ::frameTests),
        Triple("patterns.json", 100, ::patternTests),
        Triple("decoder", 15, ::decoderTests),
        Triple("session scripts", 60, ::sessionTests),
        Triple("ids", 2, ::idTests),
        Triple("peer scripts", 40, ::peerTests),
        Triple("settings", 35, ::settingsTests),
        Triple("limits", 10, ::limitTests),
        Triple("handlers", 30, ::handlerTests),
        Triple("memory", 12, ::memoryTests),
        Triple("faults.json", 20, ::faultTests),
        Triple("vectors as messages", 1800, ::vectorTests),
        Triple("package", 40, ::packageTests),
        Triple("samples", 1, ::sampleTests),
        Triple("over sockets", 20, ::netTests),
        Triple("over TLS", 7, ::tlsTests),
        Triple("metrics", 3, ::metricsTests),
    )
    val wanted = arguments.drop(1).ifEmpty { suites.map { it.first } }
    require(suites.map { it.first }.containsAll(wanted)) { "there is no such suite: $wanted" }
    for ((name, atLeast, run) in suites) if (name in wanted) tests.suite(name, atLeast, run)
    tests.end()
}
