package fc.runtime

/** What is wrong with a body. The names are those of every implementation of the protocol. */
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

    /** A value of another kind than the field's. */
    WRONG_TYPE("wrong_type"),

    /** A required key is missing. */
    MISSING_FIELD("missing_field"),

    /** A known key comes twice in its object. */
    DUPLICATE_KEY("duplicate_key"),

    /** Half of a surrogate pair stands alone in a string or key that is read. */
    LONE_SURROGATE("lone_surrogate"),

    /** A number outside the range of its type or constraint, or a value of an enum that its field does not take. */
    OUT_OF_RANGE("out_of_range"),

    /** A string, list or run of bytes of a length outside its constraint. */
    BAD_LENGTH("bad_length"),

    /** A string that does not match its pattern. */
    BAD_PATTERN("bad_pattern"),

    /** A value that a closed enum does not have. */
    UNKNOWN_VALUE("unknown_value"),

    /** An object that has the required keys of no form of a choice. */
    NO_VARIANT("no_variant"),

    /** Nested deeper than the limit. */
    TOO_DEEP("too_deep"),

    /** More keys and items than the limit. */
    TOO_MANY_VALUES("too_many_values"),

    /** The items of lists take more memory than the limit. */
    LISTS_TOO_LARGE("lists_too_large"),

    /** A string that is not base64 (RFC 4648, standard alphabet). */
    BAD_BASE64("bad_base64"),
}

/** A body that could not be read, or that breaks its constraints. */
public class BodyError internal constructor(
    /** What is wrong. */
    public val kind: BodyErrorKind,
    /** What was found and what is wanted. */
    public val detail: String,
    /** Where in the body, such as `data.stations[3].x`; empty for the body itself. */
    public val path: String = "",
    /** Characters of the text before the fault; -1 for a message that was never text. */
    public val offset: Int = -1,
) : Exception(null, null, false, false) {
    /** The fixed name of what is wrong, such as `missing_field`. */
    public val name: String get() = kind.text

    override val message: String
        get() = buildString {
            append(name)
            if (path.isNotEmpty()) append(" at `").append(path).append('`')
            if (offset >= 0) append(" (character ").append(offset).append(')')
            append(": ").append(detail)
        }

    /** The error as seen from the object that holds it under [key]. */
    internal fun inKey(key: String): BodyError = BodyError(kind, detail, joined(key), offset)

    /** The error as seen from the list that holds it at [index]. */
    internal fun inItem(index: Int): BodyError = BodyError(kind, detail, joined("[$index]"), offset)

    /** Notes where the text was being read, unless a deeper place has been noted. */
    internal fun at(offset: Int): BodyError =
        if (this.offset >= 0) this else BodyError(kind, detail, path, offset)

    private fun joined(first: String): String = when {
        path.isEmpty() -> first
        path.startsWith("[") -> first + path
        else -> "$first.$path"
    }
}

/** Longest quotation of what a peer has sent, in characters. */
private const val LONGEST_QUOTATION = 200

/** The beginning of a text that may be long. */
internal fun shortened(text: String): String =
    if (text.length <= LONGEST_QUOTATION) text else text.take(LONGEST_QUOTATION) + "…"
