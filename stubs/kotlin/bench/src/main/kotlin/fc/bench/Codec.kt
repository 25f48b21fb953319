package fc.bench

import com.google.gson.JsonElement
import com.google.gson.JsonParser
import fc.Fc
import fc.GetStationResponse
import fc.ListStationsResponse
import fc.runtime.Bodies
import fc.runtime.Decoder
import fc.runtime.Encoder
import fc.runtime.Envelopes
import fc.runtime.Frame
import fc.runtime.Message
import fc.runtime.MessageType
import java.io.File
import java.security.MessageDigest

/** The messages: names of files in `bench/frames`, and their types. */
private val MESSAGES: Map<String, MessageType<*>> =
    linkedMapOf("small" to GetStationResponse, "medium" to ListStationsResponse, "long" to ListStationsResponse)

/** Bytes of a header; the digest is its last field. */
private val HEADER = Fc.header.length
private const val DIGEST = 16

/** Uses the results, so that the compiler does not remove the work. */
private var sink: Any? = null

/** The least work of reading: checks the digest and parses all of the JSON. */
private fun leastDecode(frame: ByteArray): JsonElement {
    val digest = MessageDigest.getInstance("MD5").apply { update(frame, HEADER, frame.size - HEADER) }.digest()
    check((0 until DIGEST).all { digest[it] == frame[HEADER - DIGEST + it] }) { "another digest" }
    return JsonParser.parseString(String(frame, HEADER, frame.size - HEADER, Charsets.UTF_8))
}

/** The least work of writing: writes all of the JSON, and its digest into a prepared header. */
private fun leastEncode(frame: ByteArray, value: JsonElement): ByteArray {
    val body = value.toString().toByteArray(Charsets.UTF_8)
    val made = frame.copyOf(HEADER + body.size)
    MessageDigest.getInstance("MD5").digest(body).copyInto(made, HEADER - DIGEST)
    return body.copyInto(made, HEADER)
}

/** Returns the cost of each message in microseconds, in the format of the report. */
internal fun codec(bench: File, effort: Effort): List<Map<String, Any>> =
    MESSAGES.map { (name, type) -> message(name, File(bench, "frames/$name.bin").readBytes(), type, effort) }

private fun <M : Message> message(name: String, frame: ByteArray, type: MessageType<M>, effort: Effort): Map<String, Any> {
    val decoder = Decoder(Fc, Fc.defaults.limits)
    val encoder = Encoder(Fc, Fc.defaults.limits.frameBytes, null)
    fun opened(bytes: ByteArray): Frame {
        decoder.push(bytes, 0, bytes.size)
        return checkNotNull(decoder.next())
    }
    fun decode(bytes: ByteArray): M =
        checkNotNull(Bodies.enveloped(Fc.responseEnvelope, type, opened(bytes).body, Fc.defaults.limits.json()).body)
    val id = opened(frame).id
    val message = decode(frame)
    val success = Fc.results.success
    fun encode(): ByteArray {
        message.check()
        val envelope = Envelopes.response(Fc, System.currentTimeMillis(), success.code, success.text)
        return encoder.prepare(Bodies.write(envelope, message)).frame(id)
    }
    val plain = leastDecode(frame)
    // Each side writes everything that it reads. Only the time of the response is the current one.
    check(decode(encode()) == message && encode().size == frame.size)
    check(leastEncode(frame, plain).contentEquals(frame))
    val found = measure(
        listOf(
            { sink = leastDecode(frame) },
            { sink = decode(frame) },
            { sink = leastEncode(frame, plain) },
            { sink = encode() },
        ),
        effort,
    )
    return linkedMapOf(
        "message" to name,
        "bytes" to frame.size,
        "decode" to linkedMapOf("least" to found[0], "fc" to found[1]),
        "encode" to linkedMapOf("least" to found[2], "fc" to found[3]),
    )
}
