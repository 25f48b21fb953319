package fc.runtime

/** Watches the rate of a transfer. It makes progress if enough bytes pass within a time. */
internal class RateWatch(rate: Int, private val within: Long) {
    private val least = maxOf(1, (within.toDouble() * rate / 1000).toLong())
    private var since = 0L
    private var bytes = 0L

    fun begin(now: Long) {
        since = now
        bytes = 0
    }

    fun add(more: Int, now: Long) {
        bytes += more
        if (bytes >= least) begin(now)
    }

    /** The time when the transfer times out. */
    val deadline: Long get() = after(since, within)
}
