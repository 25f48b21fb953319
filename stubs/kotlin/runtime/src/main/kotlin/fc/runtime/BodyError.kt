package fc.runtime

/** The kind of an error in a body. All implementations of the protocol share the names. */
public enum class BodyErrorKind(
    /** The fixed name. */
    public val text: String,
) {
    /** The bytes are not UTF-8. */
    NOT_UTF8("not_utf8"),

    /** The text is not JSON (RFC 8259). */
    BAD_JSON("bad_json"),

    /** The body is JSON, but not an object. */
    NOT_AN_OBJECT("not_an_object"),

    /** A value has another JSON type than its field. */
    WRONG_TYPE("wrong_type"),

    /** A required key is missing. */
    MISSING_FIELD("missing_field"),

    /** A known key occurs twice in its object. */
    DUPLICATE_KEY("duplicate_key"),

    /** A string or key contains an unpaired surrogate. */
    LONE_SURROGATE("lone_surrogate"),

    /** A number is out of the range of its type or constraint, or the field excludes the enum value. */
    OUT_OF_RANGE("out_of_range"),

    /** The length of a string, list or byte array is out of range. */
    BAD_LENGTH("bad_length"),

    /** A string does not match its pattern. */
    BAD_PATTERN("bad_pattern"),

    /** A closed enum does not have this value. */
    UNKNOWN_VALUE("unknown_value"),

    /** An object has the required keys of no variant of its choice. */
    NO_VARIANT("no_variant"),

    /** Nested deeper than the limit. */
    TOO_DEEP("too_deep"),

    /** More keys and items than the limit. */
    TOO_MANY_VALUES("too_many_values"),

    /** The items of lists take more memory than the limit. */
    LISTS_TOO_LARGE("lists_too_large"),

    /** A string is not base64 (RFC 4648, standard alphabet). */
    BAD_BASE64("bad_base64"),
}

/** The error of a body that cannot be read, or that breaks its constraints. */
public class BodyError internal constructor(
    /** The kind of the error. */
    public val kind: BodyErrorKind,
    /** The value that was found and the one that was expected. */
    public val detail: String,
    /** The path to the error, such as `data.stations[3].x`. Empty for the body itself. */
    public val path: String = "",
    /** The offset of the error in the text, in characters. -1 for a message that was never text. */
    public val offset: Int = -1,
) : Exception(null, null, false, false) {
    /** The fixed name of the error, such as `missing_field`. */
    public val name: String get() = kind.text

    override val message: String
        get() = buildString {
            append(name)
            if (path.isNotEmpty()) append(" at `").append(path).append('`')
            if (offset >= 0) append(" (character ").append(offset).append(')')
            append(": ").append(detail)
        }

    /** Prepends [key] to the path. */
    internal fun inKey(key: String): BodyError = BodyError(kind, detail, joined(key), offset)

    /** Prepends [index] to the path. */
    internal fun inItem(index: Int): BodyError = BodyError(kind, detail, joined("[$index]"), offset)

    /** Sets the offset, unless a deeper one is set. */
    internal fun at(offset: Int): BodyError =
        if (this.offset >= 0) this else BodyError(kind, detail, path, offset)

    private fun joined(first: String): String = when {
        path.isEmpty() -> first
        path.startsWith("[") -> first + path
        else -> "$first.$path"
    }
}

/** Longest quotation of data from a peer, in characters. */
private const val LONGEST_QUOTATION = 200

/** Returns the beginning of a text that may be long. */
internal fun shortened(text: String): String =
    if (text.length <= LONGEST_QUOTATION) text else text.take(LONGEST_QUOTATION) + "…"
