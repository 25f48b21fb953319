package fc.runtime

import java.nio.ByteBuffer
import java.nio.charset.CharacterCodingException
import java.nio.charset.StandardCharsets

/** What one pass over a message with an envelope makes of it. */
internal class Enveloped<B : Message>(
    val envelope: Message,
    /** The message's own keys; `null` if something is wrong with them. */
    val body: B?,
    /** What is. A refusal that carries nothing but an envelope is still understood. */
    val fault: BodyError?,
    /** About the memory of its lists, in bytes. */
    val listBytes: Long,
)

/** Whole bodies: bytes in, a message or an error out; and back. */
internal object Bodies {
    /** Reads a body as a message. No bytes are read as `{}`. */
    fun <M : Message> decode(type: MessageType<M>, bytes: ByteArray, allowance: Allowance): M =
        reading(textOf(bytes), allowance) { reader ->
            expectObject(reader)
            type.read(reader).also { reader.end() }
        }

    /**
     * Reads the keys of an envelope, of a body and unknown ones in any order, in one pass. Unknown keys go to the body.
     *
     * @throws BodyError what keeps even the envelope from being read
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
            // The own keys must not cost the envelope: read it again, alone.
            val alone = enveloped(envelope, Empty, text, allowance)
            return Enveloped(alone.envelope, null, error, 0)
        }
    }

    /** The keys of an envelope and of a body as one object. */
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
     * A text that is not JSON is `bad_json` (or too deep, or of too many values) whatever else was wrong before that place,
     * so that the error's name does not depend on the order in which things are looked at.
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

    /** A lenient decoder takes much less time and memory. It writes a replacement for wrong bytes, and that may also be sent. */
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
