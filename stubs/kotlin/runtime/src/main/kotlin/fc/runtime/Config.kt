package fc.runtime

import java.util.Calendar
import java.util.concurrent.TimeUnit
import java.util.function.BiConsumer
import java.util.function.Consumer
import javax.net.ssl.SSLContext
import javax.net.ssl.SSLEngine

/** The schedule of reconnection attempts after a loss. */
public class Backoff private constructor(
    internal val first: Long,
    internal val longest: Long,
    internal val attempts: Int,
) {
    /** Waits 100 ms at first and twice as long each time, up to 10 s, without end. */
    public constructor() : this(100, 10_000, Int.MAX_VALUE)

    /** Wait before the first attempt. */
    public fun first(wait: Long, unit: TimeUnit): Backoff =
        Backoff(Settings.duration("Backoff.first", wait, unit), longest, attempts)

    /** Longest wait. Each wait is randomly shortened by up to a quarter, so that many apps do not reconnect at once. */
    public fun longest(wait: Long, unit: TimeUnit): Backoff =
        Backoff(first, Settings.duration("Backoff.longest", wait, unit), attempts)

    /** Consecutive failed attempts before the client gives up. */
    public fun attempts(attempts: Int): Backoff = Backoff(first, longest, Settings.integer("Backoff.attempts", attempts, 0))
}

/** The settings of a client. Unset ones are the defaults of the protocol. Each method returns a changed copy. */
public class ClientConfig private constructor(from: ClientConfig?) {
    /** Three seconds to connect, ten for a stalled frame; with reconnection, without compression. */
    public constructor() : this(null)

    internal var host: String? = from?.host
        private set
    internal var commandPort: Int? = from?.commandPort
        private set
    internal var dataPort: Int? = from?.dataPort
        private set
    internal var connectTimeout: Long = from?.connectTimeout ?: 3000
        private set
    internal var callTimeout: Long? = from?.callTimeout
        private set
    internal var reconnect: Backoff? = if (from == null) Backoff() else from.reconnect
        private set
    internal var keepalive: Boolean = from?.keepalive ?: true
        private set
    internal var stallTimeout: Long = from?.stallTimeout ?: 10_000
        private set
    internal var limits: Limits? = from?.limits
        private set
    internal var queuedBytes: Long? = from?.queuedBytes
        private set
    internal var firstId: Long? = from?.firstId
        private set
    internal var gzip: Gzip? = from?.gzip
        private set
    internal var verifyDigest: Boolean = from?.verifyDigest ?: true
        private set
    internal var resync: Boolean = from?.resync ?: false
        private set
    internal var tls: Tls? = from?.tls
        private set
    internal var log: Log? = from?.log
        private set
    internal var onCall: Consumer<EndedCall>? = from?.onCall
        private set

    private inline fun with(change: ClientConfig.() -> Unit): ClientConfig = ClientConfig(this).apply(change)

    /** Name or address of the robot. */
    public fun host(host: String): ClientConfig = with { this.host = Settings.host("ClientConfig.host", host) }

    /** Port of commands and reports. */
    public fun commandPort(port: Int): ClientConfig = with { commandPort = Settings.port("ClientConfig.commandPort", port) }

    /** Port of streams. */
    public fun dataPort(port: Int): ClientConfig = with { dataPort = Settings.port("ClientConfig.dataPort", port) }

    /** Longest time of one connection attempt. */
    public fun connectTimeout(timeout: Long, unit: TimeUnit): ClientConfig =
        with { connectTimeout = Settings.duration("ClientConfig.connectTimeout", timeout, unit) }

    /** Longest wait of a call for its response, including reconnection. */
    public fun callTimeout(timeout: Long, unit: TimeUnit): ClientConfig =
        with { callTimeout = Settings.duration("ClientConfig.callTimeout", timeout, unit) }

    /** The reconnection schedule. With `null`, the client gives up after the first loss. */
    public fun reconnect(backoff: Backoff?): ClientConfig = with { reconnect = backoff }

    /** Turns TCP keepalive on (the default) or off. The operating system sets the idle time. */
    public fun keepalive(keepalive: Boolean): ClientConfig = with { this.keepalive = keepalive }

    /**
     * Longest time without progress inside a frame, or while the robot leaves sent bytes unread. Then the client
     * reconnects. On the command port, a frame may take this time in all, plus one second for each 16 KiB.
     */
    public fun stallTimeout(timeout: Long, unit: TimeUnit): ClientConfig =
        with { stallTimeout = Settings.duration("ClientConfig.stallTimeout", timeout, unit) }

    /** Limits of everything that grows with the data from the robot. */
    public fun limits(limits: Limits): ClientConfig = with { this.limits = limits }

    /** Most bytes of reports that wait for the app. Unset: the length of the longest body. */
    public fun queuedBytes(bytes: Long): ClientConfig = with { queuedBytes = Settings.long("ClientConfig.queuedBytes", bytes, 0) }

    /** Message id of the first call. Unset: derived from the local time of day. */
    public fun firstId(id: Long): ClientConfig = with { firstId = Settings.long("ClientConfig.firstId", id, 0) }

    /** Compresses requests. Set it only for robots that accept compression. */
    public fun gzip(gzip: Gzip?): ClientConfig = with { this.gzip = gzip }

    /** Turns the verification of digests of received frames on (the default) or off. */
    public fun verifyDigest(verify: Boolean): ClientConfig = with { verifyDigest = verify }

    /** Searches for the next frame after invalid bytes. By default, the connection is closed. */
    public fun resync(resync: Boolean): ClientConfig = with { this.resync = resync }

    /**
     * Connects over TLS at both ports. The certificate of the robot must name the [host]. [configure] changes the `SSLEngine`
     * of each connection, for example its cipher suites. The handshake is a part of the [connectTimeout]. With `null`
     * (the default), connections are plain TCP.
     */
    @JvmOverloads
    public fun tls(context: SSLContext?, configure: Consumer<SSLEngine>? = null): ClientConfig =
        with { tls = context?.let { Tls(it, configure) } }

    /** Takes the log lines of the connection. Unset: errors are printed to `System.err`. */
    public fun log(log: Log?): ClientConfig = with { this.log = log }

    /** Calls [hook] with the end of each call, for metrics, on the thread of the call. An exception of the hook is logged. */
    public fun onCall(hook: Consumer<EndedCall>?): ClientConfig = with { onCall = hook }

    internal fun limitsOr(protocol: Protocol): Limits = limits ?: protocol.defaults.limits

    internal fun decoder(protocol: Protocol) = Decoder(protocol, limitsOr(protocol), verifyDigest, resync)

    internal fun encoder(protocol: Protocol) = Encoder(protocol, limitsOr(protocol).frameBytes, gzip)
}

/** The settings of a robot. Unset ones are the defaults of the protocol. Each method returns a changed copy. */
public class ServerConfig private constructor(from: ServerConfig?) {
    /** All addresses of the machine; five seconds for a header, thirty for a stalled frame. */
    public constructor() : this(null)

    internal var address: String = from?.address ?: "0.0.0.0"
        private set
    internal var commandPort: Int? = from?.commandPort
        private set
    internal var dataPort: Int? = from?.dataPort
        private set
    internal var handlerTimeout: Long? = from?.handlerTimeout
        private set
    internal var maxAge: Long? = from?.maxAge
        private set
    internal var limits: Limits? = from?.limits
        private set
    internal var queuedBytes: Long? = from?.queuedBytes
        private set
    internal var connectionsPerAddress: Int = from?.connectionsPerAddress ?: 8
        private set
    internal var abandonedHandlers: Int = from?.abandonedHandlers ?: 64
        private set
    internal var memory: Long = from?.memory ?: (256L shl 20)
        private set
    internal var firstId: Long? = from?.firstId
        private set
    internal var gzip: Gzip? = from?.gzip
        private set
    internal var verifyDigest: Boolean = from?.verifyDigest ?: true
        private set
    internal var resync: Boolean = from?.resync ?: false
        private set
    internal var headerTimeout: Long = from?.headerTimeout ?: 5000
        private set
    internal var stallTimeout: Long = from?.stallTimeout ?: 30_000
        private set
    internal var leastRate: Int = from?.leastRate ?: 1024
        private set
    internal var idleTimeout: Long? = from?.idleTimeout
        private set
    internal var keepalive: Boolean = from?.keepalive ?: true
        private set
    internal var allowed: Allowed = from?.allowed ?: Allowed.EVERYBODY
        private set
    internal var tls: Tls? = from?.tls
        private set
    internal var log: Log? = from?.log
        private set
    internal var onHandlerError: BiConsumer<Throwable, Context>? = from?.onHandlerError
        private set
    internal var onCall: Consumer<EndedCall>? = from?.onCall
        private set

    private inline fun with(change: ServerConfig.() -> Unit): ServerConfig = ServerConfig(this).apply(change)

    /** Address to listen on. */
    public fun address(address: String): ServerConfig = with { this.address = Settings.host("ServerConfig.address", address) }

    /** Port of commands and reports; 0 for any free port. */
    public fun commandPort(port: Int): ServerConfig = with { commandPort = Settings.listening("ServerConfig.commandPort", port) }

    /** Port of streams; 0 for any free port. */
    public fun dataPort(port: Int): ServerConfig = with { dataPort = Settings.listening("ServerConfig.dataPort", port) }

    /** Longest time of a handler, after which the app gets a timeout. */
    public fun handlerTimeout(timeout: Long, unit: TimeUnit): ServerConfig =
        with { handlerTimeout = Settings.duration("ServerConfig.handlerTimeout", timeout, unit) }

    /** Greatest age of a request that is still handled, by the time in its envelope. Unset: any age. */
    public fun maxAge(age: Long, unit: TimeUnit): ServerConfig =
        with { maxAge = Settings.duration("ServerConfig.maxAge", age, unit) }

    /** Limits of everything that grows with the data from apps. */
    public fun limits(limits: Limits): ServerConfig = with { this.limits = limits }

    /**
     * Most bytes of reports that wait for one app or its acknowledgement. Above it, the oldest unsent ones are dropped.
     */
    public fun queuedBytes(bytes: Long): ServerConfig = with { queuedBytes = Settings.long("ServerConfig.queuedBytes", bytes, 0) }

    /**
     * Most connections from one address, at each port; 8 by default. A further one replaces a silent connection, if
     * there is one. A silent connection has not sent a byte yet.
     */
    public fun connectionsPerAddress(limit: Int): ServerConfig =
        with { connectionsPerAddress = Settings.integer("ServerConfig.connectionsPerAddress", limit, 1) }

    /** Most handlers that continue without a waiting app; 64 by default, 0 for none. */
    public fun abandonedHandlers(limit: Int): ServerConfig =
        with { abandonedHandlers = Settings.integer("ServerConfig.abandonedHandlers", limit, 0) }

    /**
     * Most bytes that apps may make the robot hold, at both ports together; 256 MiB by default. They count received
     * frames, bodies, requests in handlers, and unsent responses, reports and streams.
     *
     * Above the limit, the connection that holds most is closed. While handlers hold half of it, requests wait. A frame
     * or body may take a quarter. Set less if the heap is not at least twice as large.
     */
    public fun memory(bytes: Long): ServerConfig = with { memory = Settings.long("ServerConfig.memory", bytes, 1) }

    /** Message id of the first report on each connection. Unset: derived from the local time of day. */
    public fun firstId(id: Long): ServerConfig = with { firstId = Settings.long("ServerConfig.firstId", id, 0) }

    /** Compresses responses and reports. Set it only for apps that accept compression. */
    public fun gzip(gzip: Gzip?): ServerConfig = with { this.gzip = gzip }

    /** Turns the verification of digests of received frames on (the default) or off. */
    public fun verifyDigest(verify: Boolean): ServerConfig = with { verifyDigest = verify }

    /** Searches for the next frame after invalid bytes. By default, the connection is closed. */
    public fun resync(resync: Boolean): ServerConfig = with { this.resync = resync }

    /** Longest time of a header, from its first byte to its last. */
    public fun headerTimeout(timeout: Long, unit: TimeUnit): ServerConfig =
        with { headerTimeout = Settings.duration("ServerConfig.headerTimeout", timeout, unit) }

    /**
     * Longest time without progress inside a frame, or while the app leaves sent bytes unread. Then the connection is
     * closed.
     */
    public fun stallTimeout(timeout: Long, unit: TimeUnit): ServerConfig =
        with { stallTimeout = Settings.duration("ServerConfig.stallTimeout", timeout, unit) }

    /** Lowest rate that counts as progress, in bytes per second, averaged over the stall timeout. */
    public fun leastRate(bytesPerSecond: Int): ServerConfig =
        with { leastRate = Settings.integer("ServerConfig.leastRate", bytesPerSecond, 0) }

    /** Longest silence of a connection between frames. Unset: no limit. */
    public fun idleTimeout(timeout: Long, unit: TimeUnit): ServerConfig =
        with { idleTimeout = Settings.duration("ServerConfig.idleTimeout", timeout, unit) }

    /** Turns TCP keepalive on (the default) or off. The operating system sets the idle time. */
    public fun keepalive(keepalive: Boolean): ServerConfig = with { this.keepalive = keepalive }

    /**
     * Allows apps from this network, such as `10.0.0.0/24`, to connect at both ports and to call commands with these
     * effects. After the first call, all other addresses are refused. Without a call, every address may call
     * everything.
     *
     * If several networks contain an address, the smallest applies. A connection from another address is closed at
     * once. A command with another effect gets the error result of the protocol, and its handler does not run. Reports
     * go to all connected apps. An address does not prove the identity of the sender.
     *
     * @throws IllegalArgumentException if it is not a network
     */
    public fun allow(network: String, vararg effects: Effect): ServerConfig =
        with { allowed = allowed.plus(Network.of(network), effects.toSet()) }

    /**
     * Serves both ports over TLS. [configure] changes the `SSLEngine` of each connection: with `needClientAuth = true`, apps
     * need a certificate too. The handshake may take the [headerTimeout]; the connection is silent in the meantime. With
     * `null` (the default), connections are plain TCP.
     */
    @JvmOverloads
    public fun tls(context: SSLContext?, configure: Consumer<SSLEngine>? = null): ServerConfig =
        with { tls = context?.let { Tls(it, configure) } }

    /** Takes the log lines of the connections. Unset: errors are printed to `System.err`. */
    public fun log(log: Log?): ServerConfig = with { this.log = log }

    /**
     * Calls [hook] with each error of a handler and its context. An error is an exception other than a [Refusal], also
     * after the handler timeout, or the reason why the response cannot be sent. It may quote the request; the log has
     * only its class and place.
     *
     * The hook runs on the thread of the handler. An exception of the hook is logged.
     */
    public fun onHandlerError(hook: BiConsumer<Throwable, Context>?): ServerConfig = with { onHandlerError = hook }

    /**
     * Calls [hook] with the end of each call, for metrics. It runs on the thread of all connections, so it must not block.
     * An exception of the hook is logged.
     */
    public fun onCall(hook: Consumer<EndedCall>?): ServerConfig = with { onCall = hook }

    internal fun limitsOr(protocol: Protocol): Limits = limits ?: protocol.defaults.limits

    /** Refuses frames and bodies above a quarter of [memory], since reading one takes up to all of it. */
    internal fun decoder(protocol: Protocol): Decoder {
        val limits = limitsOr(protocol)
        val most = maxOf(1, memory / 4)
        val bounded = limits.frameBytes(minOf(limits.frameBytes, most)).inflatedBytes(minOf(limits.inflatedBytes, most))
        return Decoder(protocol, bounded, verifyDigest, resync)
    }

    internal fun encoder(protocol: Protocol) = Encoder(protocol, limitsOr(protocol).frameBytes, gzip)
}

/** Returns the first id: the local time of day as the decimal digits `HHmmssSSS`. */
internal fun idOfNow(): Long = Calendar.getInstance().run {
    val hours = get(Calendar.HOUR_OF_DAY) * 100L + get(Calendar.MINUTE)
    (hours * 100 + get(Calendar.SECOND)) * 1000 + get(Calendar.MILLISECOND)
}
