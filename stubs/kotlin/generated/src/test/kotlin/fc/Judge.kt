package fc.runtime

import fc.Fc
import java.io.BufferedWriter

/**
 * Says of each frame, one in hex on a line, what this package makes of it, as a list in JSON on a line. Decoders in several
 * languages are compared by it; `fc-reflect/tests/it/judges.rs` says what the lists are.
 */
internal fun main() {
    val out: BufferedWriter = System.out.bufferedWriter()
    val lines = System.`in`.bufferedReader()
    while (true) {
        val line = lines.readLine() ?: break
        out.write(judged(hex(line)))
        out.newLine()
        if (!lines.ready()) out.flush()
    }
    out.flush()
}

private fun judged(bytes: ByteArray): String = try {
    verdict(bytes)
} catch (error: FrameError) {
    refused(error.name, "")
} catch (error: BodyError) {
    refused(error.name, error.path)
}

// A key may be half of a surrogate pair, which no text can hold.
private fun refused(name: String, path: String): String = "[\"refused\",\"$name\",${quoted(String(path.toByteArray()))}]"

private fun quoted(text: String): String = JsonWriter().string(text).text

private fun verdict(bytes: ByteArray): String {
    val decoder = Decoder(Fc, Fc.defaults.limits)
    decoder.push(bytes, 0, bytes.size)
    val frame = decoder.next() ?: return refused("truncated", "")
    val id = frame.id
    val header = "${if (id.isResponse) 1 else 0},${id.kind},${id.code},${id.id}"
    val raw = "[\"bytes\",$header,\"${hex(frame.body)}\"]"
    if (id.kind == Fc.streamKind) return raw
    val type = KNOWN[Triple(id.isResponse, id.kind, id.code)]
    val envelope = if (id.isResponse) Fc.responseEnvelope else Fc.requestEnvelope
    val read = Bodies.enveloped(envelope, type ?: Unlisted, frame.body, Fc.defaults.limits.json())
    read.fault?.let { throw it }
    if (type == null) return raw
    return "[\"message\",$header,${quoted(String(Bodies.write(read.envelope, read.body!!)))}]"
}

private val KNOWN: Map<Triple<Boolean, Int, Int>, MessageType<*>> = HashMap<Triple<Boolean, Int, Int>, MessageType<*>>().apply {
    for (command in Fc.commands) {
        put(Triple(false, Fc.commandKind, command.code), command.request)
        put(Triple(true, Fc.commandKind, command.code), command.response)
    }
    for (report in Fc.reports) {
        put(Triple(false, Fc.reportKind, report.code), report.message)
        put(Triple(true, Fc.reportKind, report.code), report.acknowledgement)
    }
}

/** A message of whose own keys nothing is known. */
private class Unlisted private constructor(content: Content) : Message(content) {
    override val messageType: MessageType<Unlisted> get() = Unlisted

    companion object : MessageType<Unlisted>("Unlisted") {
        override fun create(content: Content): Unlisted = Unlisted(content)
    }
}
