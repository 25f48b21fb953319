package fc.runtime

/** The kind of an error in a frame. All implementations of the protocol share the names. */
public enum class FrameErrorKind(
    /** The fixed name. */
    public val text: String,
    /** `true` if the start of the next frame is unknown, so that the connection must be closed. */
    public val isFatal: Boolean,
) {
    /** No frame begins here. */
    BAD_HEAD("bad_head", true),

    /** The total length is less than the header. */
    SHORT_FRAME("short_frame", true),

    /** The total length exceeds the limit. */
    FRAME_TOO_LONG("frame_too_long", true),

    /** The input ended inside a frame. */
    TRUNCATED("truncated", true),

    /** The protocol does not define this kind. */
    UNKNOWN_KIND("unknown_kind", false),

    /** The kind is reserved for later versions of the protocol. */
    RESERVED_KIND("reserved_kind", false),

    /** The protocol does not define this encoding. */
    UNKNOWN_ENCODING("unknown_encoding", false),

    /** The digest does not match the data. */
    BAD_DIGEST("bad_digest", false),

    /** The data is not one complete gzip member. */
    BAD_GZIP("bad_gzip", false),

    /** The length before compression does not match the data. */
    PLAIN_LENGTH_MISMATCH("plain_length_mismatch", false),

    /** The decompressed data exceeds the limit. */
    INFLATED_TOO_LONG("inflated_too_long", false),

    /** The compression ratio exceeds the limit. */
    INFLATES_TOO_MUCH("inflates_too_much", false),
}

/**
 * The error of a frame that cannot be read or sent.
 *
 * After a [fatal][FrameErrorKind.isFatal] error, the start of the next frame is unknown. After any other, the frame was
 * skipped, and [frame] identifies it for a response.
 */
public class FrameError internal constructor(
    /** The kind of the error. */
    public val kind: FrameErrorKind,
    /** The skipped frame; `null` after a fatal error. */
    public val frame: FrameId?,
    private val detail: String,
) : Exception(null, null, false, false) {
    /** The fixed name of the error, such as `bad_digest`. */
    public val name: String get() = kind.text

    override val message: String
        get() = if (frame == null) "$name: $detail" else "$name in the $frame: $detail"
}

/** The fields that match a response or acknowledgement with its request or report. */
public class FrameId(
    /** `true` for a frame with the head of responses. */
    public val isResponse: Boolean,
    /** Kind of the data. */
    public val kind: Int,
    /** Command code. */
    public val code: Int,
    /** Message id. */
    public val id: Long,
) {
    /** Returns the id of a response to this frame: the same except for the head. */
    public fun answer(): FrameId = FrameId(true, kind, code, id)

    override fun equals(other: Any?): Boolean =
        other is FrameId && other.id == id && other.code == code && other.kind == kind && other.isResponse == isResponse

    override fun hashCode(): Int = id.hashCode() * 31 + code

    override fun toString(): String {
        val what = if (isResponse) "response" else "request"
        return String.format(java.util.Locale.ROOT, "%s of kind 0x%02X, code 0x%04X, id %d", what, kind, code, id)
    }
}
