package fc.runtime

import java.net.InetAddress

/** A network: all addresses with the same first bits. */
internal class Network private constructor(private val first: ByteArray, private val prefix: Int) {
    /** Length of the prefix, of 128 bits. The longer prefix is the smaller network. */
    val size: Int get() = prefix + if (first.size == IPV4) MAPPED else 0

    fun has(address: InetAddress): Boolean {
        val bytes = address.address
        return bytes.size == first.size && starts(bytes, first, prefix)
    }

    companion object {
        private const val IPV4 = 4

        /** Bits in front of an IPv4 address that is mapped to IPv6. */
        private const val MAPPED = 96
        private val LITERAL = Regex("[0-9]+\\.[0-9]+\\.[0-9]+\\.[0-9]+|[0-9a-fA-F:.]*:[0-9a-fA-F:.]*")

        /**
         * Parses `10.0.0.0/24`, `fd00::/8`, or one address.
         *
         * @throws IllegalArgumentException if it is not a network, or has bits after its prefix
         */
        fun of(text: String): Network {
            val (address, length) = (text.split('/', limit = 2) + null)
            // Only literals are accepted, so that no name is looked up.
            require(address != null && LITERAL.matches(address)) { "`$text` has no address of IPv4 or IPv6" }
            val first = InetAddress.getByName(address).address
            // Java converts an IPv4 address mapped to IPv6 into IPv4.
            val isMapped = first.size == IPV4 && ':' in address
            val most = if (isMapped) MAPPED + 8 * IPV4 else 8 * first.size
            val written = if (length == null) most else length.toIntOrNull()?.takeIf { length.all { digit -> digit in '0'..'9' } }
            val prefix = written?.minus(if (isMapped) MAPPED else 0)
            require(prefix != null && prefix in 0..8 * first.size) { "`$text` needs a prefix of at most $most bits" }
            val zero = ByteArray(first.size)
            for (bit in 0 until prefix) zero[bit / 8] = (zero[bit / 8].toInt() or (first[bit / 8].toInt() and (0x80 shr bit % 8))).toByte()
            require(zero.contentEquals(first)) { "`$text` has bits behind its prefix" }
            return Network(first, prefix)
        }

        private fun starts(bytes: ByteArray, first: ByteArray, prefix: Int): Boolean = (0 until prefix).all { bit ->
            (bytes[bit / 8].toInt() xor first[bit / 8].toInt()) and (0x80 shr bit % 8) == 0
        }
    }
}

/** The allowed effects of each network. Without a network, everything is allowed. */
internal class Allowed private constructor(private val networks: List<Pair<Network, Set<Effect>>>) {
    fun plus(network: Network, effects: Set<Effect>): Allowed = Allowed(networks + (network to effects))

    /** Returns the effects that an address may call, or `null` if it may not connect. */
    fun effects(address: InetAddress?): Set<Effect>? {
        if (networks.isEmpty() || address == null) return ALL
        return networks.filter { it.first.has(address) }.maxByOrNull { it.first.size }?.second
    }

    companion object {
        val ALL: Set<Effect> = Effect.entries.toSet()
        val EVERYBODY = Allowed(emptyList())
    }
}
