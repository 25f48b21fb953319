package fc.runtime

import java.security.MessageDigest
import java.util.zip.CRC32

/** The role of a field of the header. */
public enum class HeaderRole {
    /** First bytes of a frame. */
    HEAD,

    /** Kind of the data. */
    KIND,

    /** Command code. */
    CODE,

    /** Message id. */
    ID,

    /** Encoding of the data. */
    ENCODING,

    /** Length of the whole frame. */
    TOTAL_LENGTH,

    /** Length of the data before compression. */
    PLAIN_LENGTH,

    /** Digest of the data as sent. */
    DIGEST,

    /** Sent, but never interpreted. */
    STATUS,
}

/** The digest algorithm. */
public enum class DigestAlgorithm(internal val size: Int) {
    /** MD5 (RFC 1321). */
    MD5(16),

    /** CRC-32 as in gzip (ISO-HDLC). */
    CRC32(4),
    ;

    internal fun digest(data: ByteArray, from: Int, length: Int): ByteArray = when (this) {
        MD5 -> MessageDigest.getInstance("MD5").apply { update(data, from, length) }.digest()
        CRC32 -> CRC32().apply { update(data, from, length) }.value.let { sum ->
            ByteArray(4) { index -> (sum shr (24 - 8 * index)).toByte() }
        }
    }
}

/** A field of the header. */
public class HeaderField private constructor(
    internal val role: HeaderRole,
    internal val size: Int,
    internal val value: Long,
    internal val algorithm: DigestAlgorithm?,
) {
    public companion object {
        /** Returns an integer of [size] bytes. For the head, [size] raw bytes. */
        @JvmStatic
        public fun of(role: HeaderRole, size: Int): HeaderField = HeaderField(role, size, 0, null)

        /** Returns an integer that is always sent with the same value. */
        @JvmStatic
        public fun constant(size: Int, value: Long): HeaderField = HeaderField(HeaderRole.STATUS, size, value, null)

        /** Returns the digest of the data as sent. */
        @JvmStatic
        public fun digest(algorithm: DigestAlgorithm): HeaderField =
            HeaderField(HeaderRole.DIGEST, algorithm.size, 0, algorithm)
    }
}

/** The fixed bytes in front of the data of every frame: its [fields] in wire order. */
public class HeaderLayout(
    /** `true` for integers with the most significant byte first. */
    public val isBigEndian: Boolean,
    fields: List<HeaderField>,
) {
    private val fields = fields.toList()
    private val offsets = IntArray(fields.size).also { offsets ->
        for (index in 1 until fields.size) offsets[index] = offsets[index - 1] + fields[index - 1].size
    }
    private val kind = place(HeaderRole.KIND)
    private val code = place(HeaderRole.CODE)
    private val id = place(HeaderRole.ID)
    private val encoding = place(HeaderRole.ENCODING)
    private val total = place(HeaderRole.TOTAL_LENGTH)
    private val plain = place(HeaderRole.PLAIN_LENGTH)
    private val digest = place(HeaderRole.DIGEST)

    /** Length in bytes. */
    public val length: Int = fields.sumOf { it.size }

    /** Largest message id. */
    internal val idMax: Long = largest(id)
    internal val algorithm: DigestAlgorithm? = if (digest < 0) null else fields[digest].algorithm

    private fun largest(field: Int): Long =
        if (fields[field].size >= Long.SIZE_BYTES) Long.MAX_VALUE else (1L shl (8 * fields[field].size)) - 1

    /** Checks a command code against the size of its field. */
    internal fun checkCode(code: Int): Long = Settings.long("code", code.toLong(), 0, largest(this.code))

    /** Checks a message id against the size of its field. */
    internal fun checkId(id: Long): Long = Settings.long("id", id, 0, idMax)

    private fun place(role: HeaderRole): Int = fields.indexOfFirst { it.role == role }

    private fun get(bytes: ByteArray, start: Int, field: Int): Long {
        var value = 0L
        val (from, size) = start + offsets[field] to fields[field].size
        for (index in 0 until size) {
            val byte = bytes[if (isBigEndian) from + index else from + size - 1 - index]
            value = value shl 8 or (byte.toLong() and 0xFF)
        }
        return value
    }

    private fun put(bytes: ByteArray, field: Int, value: Long) {
        val (from, size) = offsets[field] to fields[field].size
        for (index in 0 until size) {
            val at = if (isBigEndian) from + size - 1 - index else from + index
            bytes[at] = (value shr (8 * index)).toByte()
        }
    }

    /** Returns the total length of the frame at [start], or -1 if the field is not among the [available] bytes. */
    internal fun peekTotal(bytes: ByteArray, start: Int, available: Int): Long =
        if (available < offsets[total] + fields[total].size) -1 else get(bytes, start, total)

    /** Returns the kind of the frame at [start]. */
    internal fun peekKind(bytes: ByteArray, start: Int): Int = get(bytes, start, kind).toInt()

    /** Returns the encoding of the frame at [start]. */
    internal fun peekEncoding(bytes: ByteArray, start: Int): Int = if (encoding < 0) 0 else get(bytes, start, encoding).toInt()

    /** Returns the plain length of the frame at [start], or 0 without such a field. */
    internal fun peekPlain(bytes: ByteArray, start: Int): Long = if (plain < 0) 0 else get(bytes, start, plain)

    internal fun read(bytes: ByteArray, start: Int, isResponse: Boolean): Header {
        val data = (get(bytes, start, total) - length).coerceAtLeast(0)
        return Header(
            FrameId(isResponse, get(bytes, start, kind).toInt(), get(bytes, start, code).toInt(), get(bytes, start, id)),
            if (encoding < 0) 0 else get(bytes, start, encoding).toInt(),
            if (plain < 0) data else get(bytes, start, plain),
            if (digest < 0) ByteArray(0) else digest(bytes, start + offsets[digest]),
        )
    }

    /** Returns the digest in the byte order of the algorithm, even if integers have another one. */
    private fun digest(bytes: ByteArray, from: Int): ByteArray =
        bytes.copyOfRange(from, from + fields[digest].size).also { if (turns()) it.reverse() }

    private fun turns() = algorithm == DigestAlgorithm.CRC32 && !isBigEndian

    internal fun write(head: ByteArray, header: Header, total: Long): ByteArray {
        val bytes = ByteArray(length)
        for (index in fields.indices) {
            when (fields[index].role) {
                HeaderRole.HEAD -> head.copyInto(bytes, offsets[index])
                HeaderRole.KIND -> put(bytes, index, header.id.kind.toLong())
                HeaderRole.CODE -> put(bytes, index, header.id.code.toLong())
                HeaderRole.ID -> put(bytes, index, header.id.id)
                HeaderRole.ENCODING -> put(bytes, index, header.encoding.toLong())
                HeaderRole.TOTAL_LENGTH -> put(bytes, index, total)
                HeaderRole.PLAIN_LENGTH -> put(bytes, index, header.plainLength)
                HeaderRole.STATUS -> put(bytes, index, fields[index].value)
                HeaderRole.DIGEST -> {
                    val sum = if (turns()) header.digest.reversedArray() else header.digest
                    sum.copyInto(bytes, offsets[index])
                }
            }
        }
        return bytes
    }
}

/** The fields of a frame header. */
internal class Header(val id: FrameId, val encoding: Int, val plainLength: Long, val digest: ByteArray)
