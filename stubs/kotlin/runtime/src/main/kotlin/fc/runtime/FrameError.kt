package fc.runtime

/** What is wrong with a frame. The names are those of every implementation of the protocol. */
public enum class FrameErrorKind(
    /** The fixed name. */
    public val text: String,
    /** Whether the place of the next frame is lost, so that the connection has to be closed. */
    public val isFatal: Boolean,
) {
    /** The bytes where a frame has to begin are no head. */
    BAD_HEAD("bad_head", true),

    /** The total length is less than that of a header. */
    SHORT_FRAME("short_frame", true),

    /** The total length exceeds the limit. */
    FRAME_TOO_LONG("frame_too_long", true),

    /** The input ended inside a frame. */
    TRUNCATED("truncated", true),

    /** The kind is none of the protocol's. */
    UNKNOWN_KIND("unknown_kind", false),

    /** The kind is reserved for later versions of the protocol. */
    RESERVED_KIND("reserved_kind", false),

    /** The data is packed in a way that the protocol does not know. */
    UNKNOWN_ENCODING("unknown_encoding", false),

    /** The digest is not that of the data. */
    BAD_DIGEST("bad_digest", false),

    /** The data is not one whole gzip member. */
    BAD_GZIP("bad_gzip", false),

    /** The data has another length than the header says it has before compression. */
    PLAIN_LENGTH_MISMATCH("plain_length_mismatch", false),

    /** The data would be longer than the limit after decompression. */
    INFLATED_TOO_LONG("inflated_too_long", false),

    /** The data would grow by more than text does when it is inflated. */
    INFLATES_TOO_MUCH("inflates_too_much", false),
}

/**
 * A frame that cannot be handed on, or one that cannot be sent.
 *
 * After a [fatal][FrameErrorKind.isFatal] one nobody knows where the next frame begins. After any other, that frame has
 * been skipped, and [frame] says what to answer to.
 */
public class FrameError internal constructor(
    /** What is wrong. */
    public val kind: FrameErrorKind,
    /** The frame that was skipped; `null` after a fatal error. */
    public val frame: FrameId?,
    private val detail: String,
) : Exception(null, null, false, false) {
    /** The fixed name of what is wrong, such as `bad_digest`. */
    public val name: String get() = kind.text

    override val message: String
        get() = if (frame == null) "$name: $detail" else "$name in the $frame: $detail"
}

/** Which message a frame belongs to: what an answer to it has to echo. */
public class FrameId(
    /** Whether the frame opens with the head of responses. */
    public val isResponse: Boolean,
    /** Kind of the data. */
    public val kind: Int,
    /** Command code. */
    public val code: Int,
    /** Message id. */
    public val id: Long,
) {
    /** The id of an answer to this frame: it echoes everything but the head. */
    public fun answer(): FrameId = FrameId(true, kind, code, id)

    override fun equals(other: Any?): Boolean =
        other is FrameId && other.id == id && other.code == code && other.kind == kind && other.isResponse == isResponse

    override fun hashCode(): Int = id.hashCode() * 31 + code

    override fun toString(): String {
        val what = if (isResponse) "response" else "request"
        return String.format(java.util.Locale.ROOT, "%s of kind 0x%02X, code 0x%04X, id %d", what, kind, code, id)
    }
}
