package fc.runtime

import fc.Fc
import fc.Operations

/** The vectors of every operation of the spec as typed messages. */
internal fun vectorTests(tests: Tests): Unit = Vectors(Fc, "fc").run(tests, tests.files("fc-generated/vectors"))

/** The vectors of a protocol, whose types are in a package: read, checked, written again. */
internal class Vectors(private val protocol: Protocol, private val packageName: String) {
    /** Whether the vectors are those of the spec, which all languages run. */
    private val isShared = protocol === Fc
    private val allowance = protocol.defaults.limits.json()

    fun run(tests: Tests, files: List<java.io.File>) {
        for (file in files) {
            if (file.name == "bodies.json" || file.name == "frames.json") continue
            val vectors = Tree.of(file)
            for (case in vectors["accepted"].items) {
                tests.case("${file.name}: ${case["name"].text}", "accepted".takeIf { isShared }) { accepted(vectors, case) }
            }
            for (case in vectors["rejected"].items) {
                tests.case("${file.name}: ${case["name"].text}", "rejected".takeIf { isShared }) {
                    expect(case["error"].text, errorOf { rejected(vectors, case) })
                }
            }
        }
    }

    /** The type of a message, by the names that the package gives: also of operations that have no code yet. */
    private fun typeOf(vectors: Tree, direction: String): MessageType<*> {
        val words = vectors["operation"].text.split('_')
        val name = words.joinToString("") { word -> word.replaceFirstChar { it.uppercase() } }
        val code = vectors.find("code")?.int
        if (vectors["kind"].text == "report") {
            protocol.reports.firstOrNull { it.code == code }?.let {
                return if (direction == "request") it.message else it.acknowledgement
            }
        }
        if (vectors["kind"].text == "command") {
            protocol.commands.firstOrNull { it.code == code }?.let {
                return if (direction == "request") it.request else it.response
            }
        }
        val suffix = when (vectors["kind"].text) {
            "command" -> direction.replaceFirstChar { it.uppercase() }
            "report" -> if (direction == "request") "" else "Ack"
            else -> ""
        }
        return Class.forName("$packageName.$name$suffix").getField("Companion").get(null) as MessageType<*>
    }

    private fun envelopeOf(direction: String) =
        if (direction == "request") protocol.requestEnvelope else protocol.responseEnvelope

    private fun frameOf(hex: String): Frame {
        val decoder = Decoder(protocol, protocol.defaults.limits)
        val bytes = hex(hex)
        decoder.push(bytes, 0, bytes.size)
        val frame = decoder.next()
        decoder.finish()?.let { throw it }
        return frame ?: throw Wrong("no frame")
    }

    private fun accepted(vectors: Tree, case: Tree) {
        val direction = case["direction"].text
        val frame = case.find("frame")?.let { frameOf(it.text) }
        case.find("data")?.let { return expect(it.text, hex(frame!!.body)) }
        val text = frame?.body ?: case["text"].text.toByteArray()
        val written = if (vectors["kind"].text == "stream") {
            val message = Bodies.decode(typeOf(vectors, direction), text, allowance)
            message.check()
            message.toJson().text.toByteArray()
        } else {
            val read = Bodies.enveloped(envelopeOf(direction), typeOf(vectors, direction), text, allowance)
            val refusal = if (direction == "response") Envelopes.refusal(protocol, read.envelope) else null
            if (refusal == null) read.fault?.let { throw it }
            read.body?.check()
            expect(true, (read.body ?: read.envelope).toString().isNotEmpty())
            Bodies.write(read.envelope, read.body ?: Empty.INSTANCE)
        }
        if (case["case"].text == "plain" && frame != null) {
            expect(case["frame"].text, hex(Encoder(protocol, 1L shl 24, null).prepare(written).frame(frame.id)))
        }
        expect(case.find("canonical") ?: case["body"], Tree.of(String(written)))
    }

    private fun rejected(vectors: Tree, case: Tree) {
        val direction = case["direction"].text
        val text = case.find("frame")?.let { frameOf(it.text).body } ?: case["text"].text.toByteArray()
        if (vectors["kind"].text == "stream") {
            Bodies.decode(typeOf(vectors, direction), text, allowance)
            return
        }
        val read = Bodies.enveloped(envelopeOf(direction), typeOf(vectors, direction), text, allowance)
        read.fault?.let { throw it }
    }
}

/** What the package says of the spec beside its types. */
internal fun packageTests(tests: Tests) {
    for (command in Fc.commands) {
        tests.case("the examples of $command") {
            command.request.example().check()
            command.response.example().check()
        }
    }
    for (report in Fc.reports) tests.case("the example of $report") { report.message.example().check() }
    tests.case("all commands have a code of their own") {
        expect(Fc.commands.size, Fc.commands.map { it.code }.toSet().size)
        expect(Fc.reports.size, Fc.reports.map { it.code }.toSet().size)
    }
    tests.case("a state of a report, and what follows it") {
        val state = fc.RechargeStatus.NAVIGATING
        expect(listOf(true, false, true), listOf(
            fc.RechargeStatus.AT_UNDOCK_POINT.mayFollow(state),
            fc.RechargeStatus.CHARGING.mayFollow(state),
            fc.RechargeStatus.of(77).mayFollow(state),
        ))
        expect(true, fc.RechargeError.FAILED.isError)
        val report = fc.RechargeProgress.example()
        expect(true, Operations.rechargeProgress.stateIn(report) != null)
        expect(false, Operations.rechargeProgress.isFailure(report))
    }
    tests.case("tables") { expect(true, fc.Tables.cellLayouts().all { it.cells.size == it.cellCount }) }
}
