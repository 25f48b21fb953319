package fc.runtime

import java.nio.ByteBuffer
import java.nio.charset.CharacterCodingException
import java.nio.charset.StandardCharsets

/** The outcome of reading a message with an envelope in one pass. */
internal class Enveloped<B : Message>(
    val envelope: Message,
    /** The message; `null` if it has an error. */
    val body: B?,
    /** The error of the message. A refusal with nothing but an envelope is thus understood. */
    val fault: BodyError?,
    /** Memory of its lists, in bytes (an estimate). */
    val listBytes: Long,
)

/** Reads and writes complete bodies: bytes to messages and back. */
internal object Bodies {
    /** Reads a body as a message. An empty body is read as `{}`. */
    fun <M : Message> decode(type: MessageType<M>, bytes: ByteArray, allowance: Allowance): M =
        reading(textOf(bytes), allowance) { reader ->
            expectObject(reader)
            type.read(reader).also { reader.end() }
        }

    /**
     * Reads the keys of an envelope and of a body in any order, in one pass. The body keeps unknown keys.
     *
     * @throws BodyError if even the envelope cannot be read
     */
    fun <B : Message> enveloped(
        envelope: MessageType<*>,
        type: MessageType<B>,
        bytes: ByteArray,
        allowance: Allowance,
    ): Enveloped<B> = enveloped(envelope, type, textOf(bytes), allowance)

    private fun <B : Message> enveloped(
        envelope: MessageType<*>,
        type: MessageType<B>,
        text: String,
        allowance: Allowance,
    ): Enveloped<B> {
        var isBody = false
        try {
            return reading(text, allowance) { reader ->
                expectObject(reader)
                val start = reader.beginObject()
                val outer = Draft(envelope)
                val inner = Draft(type)
                while (!reader.endObject()) {
                    val key = reader.key()
                    if (!outer.take(reader, key)) {
                        isBody = true
                        if (!inner.take(reader, key)) {
                            isBody = false
                            inner.keep(reader, key)
                        }
                        isBody = false
                    }
                    reader.endValue()
                }
                reader.end()
                val made = outer.finish(reader, start)
                isBody = true
                Enveloped(made, inner.finish(reader, start), null, reader.spentListBytes)
            }
        } catch (error: BodyError) {
            if (!isBody) throw error
            // An error of the message must not hide the envelope: read it again, alone.
            val alone = enveloped(envelope, Empty, text, allowance)
            return Enveloped(alone.envelope, null, error, 0)
        }
    }

    /** Writes the keys of an envelope and of a body as one object. */
    fun write(envelope: Message, body: Message): ByteArray {
        val writer = JsonWriter().beginObject()
        envelope.messageType.writeFields(writer, envelope)
        body.messageType.writeFields(writer, body)
        return writer.endObject().text.toByteArray(StandardCharsets.UTF_8)
    }

    private fun expectObject(reader: JsonReader) {
        if (reader.peek() == '{') return
        throw reader.fault(BodyErrorKind.NOT_AN_OBJECT, reader.unexpected("an object").detail)
    }

    /**
     * Reads a text. Invalid JSON takes precedence over earlier errors, as do too deep nesting and too many values. The
     * name of the error thus does not depend on the order of the checks.
     */
    private inline fun <T> reading(text: String, allowance: Allowance, read: (JsonReader) -> T): T {
        try {
            return read(JsonReader(text, allowance))
        } catch (error: BodyError) {
            JsonReader(text, allowance).apply {
                skipValue()
                end()
            }
            throw error
        }
    }

    private fun textOf(bytes: ByteArray): String = if (bytes.isEmpty()) "{}" else utf8(bytes)

    /**
     * Decodes UTF-8. A lenient decoder takes much less time and memory. It replaces invalid bytes by U+FFFD, which a
     * valid text may also contain.
     */
    fun utf8(bytes: ByteArray): String {
        val text = String(bytes, StandardCharsets.UTF_8)
        if (text.indexOf(REPLACEMENT) < 0) return text
        try {
            return StandardCharsets.UTF_8.newDecoder().decode(ByteBuffer.wrap(bytes)).toString()
        } catch (_: CharacterCodingException) {
            throw BodyError(BodyErrorKind.NOT_UTF8, "a body is UTF-8 text")
        }
    }

    private const val REPLACEMENT = '\uFFFD'
}
