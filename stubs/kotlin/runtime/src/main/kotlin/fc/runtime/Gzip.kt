package fc.runtime

import java.util.zip.CRC32
import java.util.zip.DataFormatException
import java.util.zip.Deflater
import java.util.zip.Inflater

/** Threshold and level of the compression of sent frames. Data that does not shrink is sent uncompressed. */
public class Gzip @JvmOverloads constructor(
    /** Least length of data to compress, in bytes. */
    public val fromBytes: Int = 1024,
    /** 1 (fast) to 9 (small). */
    public val level: Int = 1,
) {
    init {
        Settings.integer("Gzip.fromBytes", fromBytes, 0)
        Settings.integer("Gzip.level", level, 1, 9)
    }
}

/** Compresses [data] into a gzip member. Returns `null` if that is not shorter. */
internal fun deflated(data: ByteArray, level: Int): ByteArray? {
    val room = data.size - GZIP_HEADER.size - GZIP_TRAILER
    if (room <= 0) return null
    val out = ByteArray(data.size)
    GZIP_HEADER.copyInto(out)
    val deflater = Deflater(level, true)
    try {
        deflater.setInput(data)
        deflater.finish()
        val length = deflater.deflate(out, GZIP_HEADER.size, room)
        val end = GZIP_HEADER.size + length
        if (!deflater.finished() || end + GZIP_TRAILER >= data.size) return null
        putLittle(out, end, CRC32().apply { update(data, 0, data.size) }.value)
        putLittle(out, end + 4, data.size.toLong())
        return out.copyOf(end + GZIP_TRAILER)
    } finally {
        deflater.end()
    }
}

/** The outcome of a decompression. */
internal sealed interface Inflated {
    class Data(val bytes: ByteArray) : Inflated

    /** Not one intact member. */
    object Damaged : Inflated

    /** Another length than announced. */
    object OtherLength : Inflated
}

/**
 * Decompresses one gzip member, which must be exactly [plain] bytes long. Memory grows only with the actual output, up
 * to [plain] bytes.
 */
internal fun inflated(bytes: ByteArray, from: Int, to: Int, plain: Int): Inflated {
    val start = behindHeader(bytes, from, to)
    if (start < 0) return Inflated.Damaged
    val inflater = Inflater(true)
    try {
        inflater.setInput(bytes, start, to - start)
        var out = ByteArray(minOf(plain.toLong(), maxOf(4L * (to - start), 4096L)).toInt())
        var filled = 0
        while (!inflater.finished()) {
            if (filled == plain) {
                // The buffer is full. A stream that continues here is too long.
                if (inflater.inflate(ByteArray(1)) > 0) return Inflated.OtherLength
                if (!inflater.finished()) return Inflated.Damaged
                break
            }
            if (filled == out.size) out = out.copyOf(minOf(plain.toLong(), GROWTH * out.size).toInt())
            val more = inflater.inflate(out, filled, out.size - filled)
            if (more == 0 && !inflater.finished()) return Inflated.Damaged
            filled += more
        }
        val trailer = to - inflater.remaining
        if (to - trailer != GZIP_TRAILER) return Inflated.Damaged
        val sum = CRC32().apply { update(out, 0, filled) }.value
        if (little(bytes, trailer) != sum || little(bytes, trailer + 4) != filled.toLong()) return Inflated.Damaged
        if (filled != plain) return Inflated.OtherLength
        return Inflated.Data(if (out.size == filled) out else out.copyOf(filled))
    } catch (_: DataFormatException) {
        return Inflated.Damaged
    } finally {
        inflater.end()
    }
}

private val GZIP_HEADER = byteArrayOf(0x1F, 0x8B.toByte(), 8, 0, 0, 0, 0, 0, 0, 0xFF.toByte())
private const val GZIP_TRAILER = 8

/** Growth factor of the output buffer. Each larger buffer leaves garbage. */
private const val GROWTH = 8L

private fun putLittle(bytes: ByteArray, at: Int, value: Long) {
    for (index in 0 until 4) bytes[at + index] = (value shr (8 * index)).toByte()
}

private fun little(bytes: ByteArray, at: Int): Long =
    (3 downTo 0).fold(0L) { value, index -> value shl 8 or (bytes[at + index].toLong() and 0xFF) }

/**
 * Returns the end of the header of a member, including optional fields that some compressors write. -1 if there is
 * none.
 */
private fun behindHeader(bytes: ByteArray, from: Int, to: Int): Int {
    if (to - from < GZIP_HEADER.size || (0 until 3).any { bytes[from + it] != GZIP_HEADER[it] }) return -1
    val flags = bytes[from + 3].toInt()
    if (flags and 0b1110_0000 != 0) return -1
    var at = from + GZIP_HEADER.size
    if (flags and 0b0000_0100 != 0) {
        if (to - at < 2) return -1
        at += 2 + (bytes[at].toInt() and 0xFF) + (bytes[at + 1].toInt() and 0xFF).shl(8)
    }
    for (text in intArrayOf(0b0000_1000, 0b0001_0000)) {
        if (flags and text == 0) continue
        while (at < to && bytes[at].toInt() != 0) at++
        at++
    }
    if (flags and 0b0000_0010 != 0) at += 2
    return if (at <= to) at else -1
}
