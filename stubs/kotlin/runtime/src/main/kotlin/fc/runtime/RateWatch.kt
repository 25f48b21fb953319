package fc.runtime

/** Whether bytes come, or go, as fast as they have to: so many in so much time are progress, fewer are none. */
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

    /** When it has been too slow for too long. */
    val deadline: Long get() = after(since, within)
}
