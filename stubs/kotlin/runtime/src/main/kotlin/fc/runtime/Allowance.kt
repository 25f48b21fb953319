package fc.runtime

/** Limits for reading one JSON text. */
internal class Allowance(
    /** Deepest nesting. */
    depth: Int,
    /** Most keys of objects and items of lists, over all levels. */
    val values: Int,
    /** Most memory for the items of lists, in bytes (an estimate). */
    val listBytes: Long,
) {
    val depth: Int = minOf(depth, MAX_DEPTH)

    companion object {
        /** Deepest nesting that the reader supports, whatever the settings. Each level takes stack. */
        const val MAX_DEPTH = 127

        val DEFAULT: Allowance = Allowance(MAX_DEPTH, 1 shl 20, 32L shl 20)

        /** For the text inside a string. */
        val NOTHING: Allowance = Allowance(0, Int.MAX_VALUE, Long.MAX_VALUE)

        /** For trusted text. */
        val ANY: Allowance = Allowance(MAX_DEPTH, Int.MAX_VALUE, Long.MAX_VALUE)
    }
}
