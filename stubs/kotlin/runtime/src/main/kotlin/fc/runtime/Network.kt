package fc.runtime

import java.net.InetAddress

/** A network: all addresses that begin with the same bits. */
internal class Network private constructor(private val first: ByteArray, private val prefix: Int) {
    /** How many bits its addresses share, of 128: of two networks that hold an address, the one with more is the smaller. */
    val size: Int get() = prefix + if (first.size == IPV4) MAPPED else 0

    fun has(address: InetAddress): Boolean {
        val bytes = address.address
        return bytes.size == first.size && starts(bytes, first, prefix)
    }

    companion object {
        private const val IPV4 = 4

        /** Bits of an address of IPv6 in front of one of IPv4 in it. */
        private const val MAPPED = 96
        private val LITERAL = Regex("[0-9]+\\.[0-9]+\\.[0-9]+\\.[0-9]+|[0-9a-fA-F:.]*:[0-9a-fA-F:.]*")

        /**
         * `10.0.0.0/24`, `fd00::/8`, or one address.
         *
         * @throws IllegalArgumentException if it is not a network, or has bits behind its prefix
         */
        fun of(text: String): Network {
            val (address, length) = (text.split('/', limit = 2) + null)
            // No name is looked up for it.
            require(address != null && LITERAL.matches(address)) { "`$text` has no address of IPv4 or IPv6" }
            val first = InetAddress.getByName(address).address
            // What Java makes of an address of IPv4 inside one of IPv6.
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

/** Who may do what: nothing is said of anybody, or of all. */
internal class Allowed private constructor(private val networks: List<Pair<Network, Set<Effect>>>) {
    fun plus(network: Network, effects: Set<Effect>): Allowed = Allowed(networks + (network to effects))

    /** What may be called from an address; `null` if nobody may connect from there. */
    fun effects(address: InetAddress?): Set<Effect>? {
        if (networks.isEmpty() || address == null) return ALL
        return networks.filter { it.first.has(address) }.maxByOrNull { it.first.size }?.second
    }

    companion object {
        val ALL: Set<Effect> = Effect.entries.toSet()
        val EVERYBODY = Allowed(emptyList())
    }
}
