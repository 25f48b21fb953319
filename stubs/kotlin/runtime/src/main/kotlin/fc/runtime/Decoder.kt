package fc.runtime

/** A received frame with decompressed data. */
internal class Frame(val id: FrameId, val digest: ByteArray, val encoding: Int, val plainLength: Long, val body: ByteArray)

/**
 * Splits a stream of bytes into frames.
 *
 * The decoder refuses invalid input early: a wrong head at its first wrong byte, an impossible length before the data
 * has arrived. Memory grows only with bytes that have arrived.
 */
internal class Decoder(
    private val protocol: Protocol,
    private val limits: Limits,
    private val verifyDigest: Boolean = true,
    private val resync: Boolean = false,
) {
    private val layout = protocol.header
    private val requestHead = protocol.requestHead.toByteArray()
    private val responseHead = protocol.responseHead.toByteArray()
    private var buffer = ByteArray(0)
    private var start = 0
    private var end = 0
    private var failed: FrameError? = null

    /** `true` if bytes were skipped and no frame has been found since. */
    private var isSearching = false

    /** Bytes of frames that this search has tried without success. */
    private var tried = 0L

    /** Decompressed bytes in excess of the compressed ones, since the last [takeSurplus]. */
    private var surplus = 0L

    /** Returns and resets [surplus]. */
    fun takeSurplus(): Long = surplus.also { surplus = 0 }

    /** Number of received bytes that were not returned as frames yet. */
    val pending: Int get() = end - start

    /** The announced length of the current frame. Until it has arrived, the length of a header. */
    val expected: Long
        get() = layout.peekTotal(buffer, start, pending).let { if (it < 0) layout.length.toLong() else it }

    /** `true` if the header of the current frame is incomplete. */
    val isInsideHeader: Boolean get() = pending in 1 until layout.length

    /** Size of the buffer, in bytes. */
    val capacity: Long get() = buffer.size.toLong()

    /** Size of the larger buffer that pushing [length] bytes needs, or 0 if they fit into this one. */
    fun growth(length: Int): Long = if (pending + length <= buffer.size) 0 else grown(pending + length).toLong()

    private fun grown(needed: Int): Int = maxOf(needed.toLong(), minOf(2L * buffer.size, limits.frameBytes), 512L).toInt()

    /** Memory for the first frame with its text and message, in bytes (an estimate). 0 if the frame is incomplete. */
    fun cost(): Long {
        val total = layout.peekTotal(buffer, start, pending)
        if (total < layout.length || total > pending) return 0
        val isPacked = layout.peekEncoding(buffer, start) == protocol.gzipEncoding
        val length = if (isPacked) minOf(layout.peekPlain(buffer, start), limits.inflatedBytes) else total
        return if (layout.peekKind(buffer, start) == protocol.streamKind) length else READING * length
    }

    /** Frees the buffer if it is empty. */
    fun tidy() {
        if (pending == 0) close()
    }

    /** Forgets all received bytes. */
    fun close() {
        start = 0
        end = 0
        buffer = ByteArray(0)
    }

    fun push(bytes: ByteArray, from: Int, length: Int) {
        if (start > 0 && (start == end || end + length > buffer.size)) {
            buffer.copyInto(buffer, 0, start, end)
            end -= start
            start = 0
        }
        if (end + length > buffer.size) {
            buffer = buffer.copyOf(grown(end + length))
        }
        bytes.copyInto(buffer, end, from, from + length)
        end += length
    }

    /**
     * Returns the next complete frame, or `null` if it has not arrived yet.
     *
     * @throws FrameError once for each skipped frame; after a fatal error, on every call
     */
    fun next(): Frame? {
        failed?.let { throw it }
        while (true) {
            val located = try {
                locate()
            } catch (error: FrameError) {
                if (!resync) {
                    failed = error
                    throw error
                }
                search()
                continue
            }
            val (header, length) = located ?: return null
            try {
                val body = check(header, start + layout.length, start + length)
                isSearching = false
                tried = 0
                consume(length)
                return Frame(header.id, header.digest, header.encoding, header.plainLength, body)
            } catch (error: FrameError) {
                if (!isSearching) {
                    consume(length)
                    throw error
                }
                tried += length
                if (tried > SEARCH * limits.frameBytes) throw fatal(FrameErrorKind.BAD_HEAD, NO_HEAD).also { failed = it }
                search()
            }
        }
    }

    /** Returns the error if the stream must not end here. */
    fun finish(): FrameError? = failed ?: if (pending == 0 || isSearching) {
        null
    } else {
        fatal(FrameErrorKind.TRUNCATED, "the stream ended with $pending bytes of a frame received")
    }

    private fun consume(length: Int) {
        start += length
        if (start == end) {
            start = 0
            end = 0
            if (buffer.size > KEEP) buffer = ByteArray(0)
        }
    }

    /** Returns the header and length of the first frame, if it is complete. All its errors are fatal. */
    private fun locate(): Pair<Header, Int>? {
        val isRequest = opens(start, requestHead)
        if (!isRequest && !opens(start, responseHead)) throw fatal(FrameErrorKind.BAD_HEAD, NO_HEAD)
        val total = layout.peekTotal(buffer, start, pending)
        if (total < 0) return null
        if (total > limits.frameBytes) {
            throw fatal(FrameErrorKind.FRAME_TOO_LONG, "it has $total bytes; the limit is ${limits.frameBytes}")
        }
        if (total < layout.length) {
            throw fatal(FrameErrorKind.SHORT_FRAME, "it claims $total bytes; its header has ${layout.length}")
        }
        if (pending < total) return null
        return layout.read(buffer, start, !isRequest) to total.toInt()
    }

    /** Checks a complete frame and returns its data. The order decides between several errors. */
    private fun check(header: Header, from: Int, to: Int): ByteArray {
        val kind = header.id.kind
        if (kind in protocol.reservedKinds) throw skipped(FrameErrorKind.RESERVED_KIND, header, "the kind is reserved")
        if (kind != protocol.commandKind && kind != protocol.reportKind && kind != protocol.streamKind) {
            throw skipped(FrameErrorKind.UNKNOWN_KIND, header, "the protocol has no such kind")
        }
        val packed = header.encoding == protocol.gzipEncoding
        if (!packed && header.encoding != protocol.plainEncoding) {
            throw skipped(FrameErrorKind.UNKNOWN_ENCODING, header, "encoding ${header.encoding}")
        }
        val algorithm = layout.algorithm
        if (verifyDigest && algorithm != null && !algorithm.digest(buffer, from, to - from).contentEquals(header.digest)) {
            throw skipped(FrameErrorKind.BAD_DIGEST, header, "it was damaged on its way")
        }
        val plain = header.plainLength
        if (packed) return inflate(header, from, to)
        if (plain != (to - from).toLong() && !(protocol.takesZeroPlainLength && plain == 0L)) throw otherLength(header)
        return buffer.copyOfRange(from, to)
    }

    private fun inflate(header: Header, from: Int, to: Int): ByteArray {
        val plain = header.plainLength
        if (plain > limits.inflatedBytes) {
            val detail = "it inflates to $plain bytes; the limit is ${limits.inflatedBytes}"
            throw skipped(FrameErrorKind.INFLATED_TOO_LONG, header, detail)
        }
        val most = limits.inflateRatio * (to - from)
        if (header.id.kind != protocol.streamKind && plain > Limits.INFLATE_FREE && plain > most) {
            val detail = "it inflates from ${to - from} bytes to $plain; the limit is ${limits.inflateRatio} times as many"
            throw skipped(FrameErrorKind.INFLATES_TOO_MUCH, header, detail)
        }
        return when (val inflated = inflated(buffer, from, to, plain.toInt())) {
            is Inflated.Data -> inflated.bytes.also { surplus += maxOf(0, it.size - (to - from)) }
            Inflated.Damaged -> throw skipped(FrameErrorKind.BAD_GZIP, header, "not one intact gzip member")
            Inflated.OtherLength -> throw otherLength(header)
        }
    }

    private fun otherLength(header: Header) =
        skipped(FrameErrorKind.PLAIN_LENGTH_MISMATCH, header, "the header says ${header.plainLength} bytes")

    private fun skipped(kind: FrameErrorKind, header: Header, detail: String) = FrameError(kind, header.id, detail)

    private fun fatal(kind: FrameErrorKind, detail: String) = FrameError(kind, null, detail)

    /** Skips to the next position that may be a head. */
    private fun search() {
        var at = start + 1
        while (at < end && !opens(at, requestHead) && !opens(at, responseHead)) at++
        isSearching = true
        consume(minOf(at, end) - start)
    }

    /** Returns `true` if the received bytes at [at] match the start of [head]. */
    private fun opens(at: Int, head: ByteArray): Boolean =
        head.indices.all { at + it >= end || buffer[at + it] == head[it] }

    private companion object {
        /** Longest search without success, in multiples of the longest frame. */
        const val SEARCH = 4L

        /** Memory of a body, its text and its message, in multiples of the body. */
        const val READING = 3L

        /** Capacity that an empty buffer keeps, in bytes. */
        const val KEEP = 64 * 1024
        const val NO_HEAD = "no frame begins here"
    }
}
