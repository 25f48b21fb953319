package fc.runtime

/** What reading one text may cost. */
internal class Allowance(
    /** Levels of nesting. */
    depth: Int,
    /** Keys of objects and items of lists, those of all levels together. */
    val values: Int,
    /** Memory for the items of lists, about, in bytes. */
    val listBytes: Long,
) {
    val depth: Int = minOf(depth, MAX_DEPTH)

    companion object {
        /** Deepest nesting that the reader follows, whatever is configured: each level takes stack. */
        const val MAX_DEPTH = 127

        val DEFAULT: Allowance = Allowance(MAX_DEPTH, 1 shl 20, 32L shl 20)

        /** For what is inside a string. */
        val NOTHING: Allowance = Allowance(0, Int.MAX_VALUE, Long.MAX_VALUE)

        /** For text of one's own. */
        val ANY: Allowance = Allowance(MAX_DEPTH, Int.MAX_VALUE, Long.MAX_VALUE)
    }
}
