package fc.runtime

import java.net.InetAddress
import java.net.InetSocketAddress
import java.net.SocketAddress
import java.util.Locale
import javax.net.ssl.SSLEngine
import kotlinx.coroutines.CoroutineExceptionHandler
import kotlinx.coroutines.CoroutineScope
import kotlinx.coroutines.Job

/** A robot without threads and sockets. It runs on its loop, except for handlers, which run in [scope]. */
internal class ServerCore(
    val protocol: Protocol,
    val config: ServerConfig,
    val loop: Loop,
    val service: Service,
    val scope: CoroutineScope,
) {
    val limits: Limits = config.limitsOr(protocol)
    val counting = Counting<ServerCount>(ServerCount.entries.size)
    val encoder: Encoder = config.encoder(protocol)
    val commands = protocol.commands.associateBy { it.code }
    val inbox: StreamInbox = StreamInbox(config.queuedBytes ?: limits.inflatedBytes) {
        loop.execute {
            dataPeers.forEach { it.wake() }
            memory.gaveBack()
        }
    }
    val lines = Lines(config.log, protocol) { loop.now }

    /** Takes failures around handlers, such as those of their dispatcher. */
    val handlerFaults = CoroutineExceptionHandler { _, failure ->
        loop.execute { lines.failed("the dispatcher of handlers failed", failure) }
    }
    private val peers = ArrayList<Peer>()
    private val dataPeers = ArrayList<DataPeer>()
    val memory: MemoryBudget = MemoryBudget(config.memory, { peers + dataPeers }, { inbox.bytes }, ::evict)
    private var lastConnection = 0L

    /** Handlers that continue without a waiting app. */
    private val abandoned = HashSet<Job>()
    private var life = Life.RUNNING
    private var cutOff: Timer? = null
    private var cutOffAt = Long.MAX_VALUE
    private val waitsForEnd = ArrayList<() -> Unit>()

    private enum class Life { RUNNING, STOPPING, OVER }

    /** Serves a command connection. Returns `false` if it is refused. */
    fun serve(link: Link, address: SocketAddress?): Boolean {
        val effects = allowed(address) ?: return false
        val peer = Peer(this, link, ++lastConnection, address, effects)
        val isAdmitted = admit(peers, peer, address, { it.address }) { !it.isHeard }
        if (!isAdmitted) return false
        dataPeers.filter { isSame(it.address, address) }.forEach { it.saw(peer.id) }
        counting.add(ServerCount.CONNECTIONS)
        lines.say(LogLevel.INFO, "connected") { "connected: ${peer.id} from $address" }
        peer.start()
        return true
    }

    /** Serves a data connection. Returns `false` if it is refused. */
    fun serveData(link: Link, address: SocketAddress?): Boolean {
        allowed(address) ?: return false
        val peer = DataPeer(this, link, ++lastConnection, address)
        val isAdmitted = admit(dataPeers, peer, address, { it.address }) { silent ->
            // An app that only receives streams is recognized by its commands.
            !silent.isHeard && peers.none { it.isHeard && isSame(it.address, silent.address) }
        }
        if (!isAdmitted) return false
        peers.filter { isSame(it.address, address) }.forEach { peer.saw(it.id) }
        counting.add(ServerCount.DATA_CONNECTIONS)
        lines.say(LogLevel.INFO, "connected") { "connected at the data port: ${peer.id} from $address" }
        peer.start()
        return true
    }

    /** Puts TLS on a link. The handshake is a part of the served connection, and has as much time as a header. */
    fun secured(link: Link, engine: SSLEngine, address: SocketAddress?): Link {
        val secured = TlsLink(loop, link, engine) { error ->
            counting.add(ServerCount.HANDSHAKES_FAILED)
            lines.say(LogLevel.WARN, "handshake") { "the handshake failed: ${error.message}; from $address" }
        }
        secured.shakeUntil(after(loop.now, config.headerTimeout))
        return secured
    }

    private inline fun left(id: Long, leave: () -> Unit) {
        lines.say(LogLevel.INFO, "ended") { "ended: $id" }
        leave()
    }

    private fun evict(holder: MemoryHolder) {
        val weight = holder.weight
        val peer = holder as Conversation
        val (id, address) = if (peer is Peer) peer.id to peer.address else (peer as DataPeer).run { id to address }
        counting.add(ServerCount.CONNECTIONS_EVICTED)
        lines.say(LogLevel.WARN, "evicted") { "closed: memory is short, and $id from $address held most, $weight bytes" }
        peer.cut()
        inbox.drop(id)
        leave(peer)
    }

    /** Logs an error of a handler or its response, and calls the hook. Runs on the thread of the handler. */
    fun handlerFailed(error: Throwable, context: Context, called: Any, what: (String) -> String) {
        val name = commands[context.code]?.name
        val line = what(name ?: String.format(Locale.ROOT, "0x%04X", context.code))
        // Apps choose the codes, so all unknown codes are one cause.
        loop.execute { lines.failed(line, error, called, what(name ?: "")) }
        val hook = config.onHandlerError ?: return
        try {
            hook.accept(error, context)
        } catch (failure: Throwable) {
            loop.execute { lines.failed("`onHandlerError` failed", failure, hook) }
        }
    }

    /** Calls the hook for the end of a call of the app that began at [since]. */
    fun callEnded(code: Int, result: String, since: Long) {
        val hook = config.onCall ?: return
        try {
            hook.accept(EndedCall.of(protocol, code, result, since))
        } catch (failure: Throwable) {
            lines.failed("`onCall` failed", failure, hook)
        }
    }

    /** Returns the effects that an address may call, or `null` if it may not connect. */
    private fun allowed(address: SocketAddress?): Set<Effect>? {
        val effects = config.allowed.effects(host(address))
        if (effects == null) {
            counting.add(ServerCount.CONNECTIONS_FORBIDDEN)
            lines.say(LogLevel.WARN, "forbidden") { "refused: the address is not allowed: $address" }
        }
        return effects
    }

    private fun host(address: SocketAddress?): InetAddress? = (address as? InetSocketAddress)?.address

    private fun isSame(one: SocketAddress?, other: SocketAddress?) = host(one) == host(other)

    /** Adds a connection. At the limit, it replaces a silent one. Returns `false` if there is none. */
    private fun <P : Conversation> admit(
        table: ArrayList<P>,
        peer: P,
        address: SocketAddress?,
        addressOf: (P) -> SocketAddress?,
        isSilent: (P) -> Boolean,
    ): Boolean {
        if (life != Life.RUNNING) return false
        val crowd = table.groupingBy { host(addressOf(it)) }.eachCount()
        val isCrowded = (crowd[host(address)] ?: 0) >= config.connectionsPerAddress
        if (isCrowded || table.size >= limits.connections) {
            // The oldest from the address with most connections.
            val silent = table.filter { (!isCrowded || isSame(addressOf(it), address)) && isSilent(it) }
            val displaced = silent.maxByOrNull { crowd[host(addressOf(it))] ?: 0 }
            if (displaced == null) {
                counting.add(ServerCount.CONNECTIONS_REFUSED)
                lines.say(LogLevel.WARN, "refused") { "refused: too many connections; the new one is from $address" }
                return false
            }
            counting.add(ServerCount.CONNECTIONS_DISPLACED)
            lines.say(LogLevel.WARN, "displaced") { "silent, and closed for a new one: ${addressOf(displaced)} for $address" }
            leave(displaced)
            displaced.part()
        }
        table.add(peer)
        return true
    }

    fun leave(conversation: Conversation) {
        when (conversation) {
            is Peer -> if (peers.remove(conversation)) left(conversation.id) { conversation.left() }
            is DataPeer -> if (dataPeers.remove(conversation)) left(conversation.id) { conversation.left() }
        }
        memory.leave(conversation as MemoryHolder)
        lookForEnd()
    }

    /** Number of closing connections, which also delay the end. */
    var parting = 0
        private set

    fun parts() {
        parting++
    }

    fun gone() {
        parting--
        lookForEnd()
    }

    // Abandoned handlers.

    val isAbandonedFull: Boolean get() = config.abandonedHandlers > 0 && abandoned.size >= config.abandonedHandlers

    /** Abandons a handler without a waiting app: it continues or is cancelled. */
    fun abandon(job: Job, effect: Effect) {
        val runsOn = (effect == Effect.MOTION || effect == Effect.UNKNOWN) && config.abandonedHandlers > 0 && life != Life.OVER
        if (!runsOn) return job.cancel()
        counting.add(ServerCount.HANDLERS_ABANDONED)
        abandoned.add(job)
        job.invokeOnCompletion {
            loop.execute {
                abandoned.remove(job)
                lookForEnd()
            }
        }
    }

    // Pushing.

    fun push(audience: Audience, report: (connection: Long) -> Queued): Int {
        val found = if (audience.connection == null) peers.toList() else peers.filter { it.id == audience.connection }
        if (found.isEmpty() && audience.connection != null) return -1
        found.forEach { it.push(report(it.id)) }
        return found.size
    }

    /** Returns the data connections of an audience. */
    fun dataAudience(audience: Audience): List<DataPeer> {
        val app = audience.connection ?: return dataPeers.toList()
        dataPeers.firstOrNull { it.id == app }?.let { return listOf(it) }
        val own = dataPeers.filter { it.owner == app }
        if (own.isNotEmpty()) return own
        val address = peers.firstOrNull { it.id == app }?.address
        val isAmbiguous = address != null && dataPeers.any { isSame(it.address, address) && it.owner == DataPeer.SEVERAL }
        throw PushError(if (isAmbiguous) PushErrorKind.AMBIGUOUS else PushErrorKind.NO_CONNECTION)
    }

    fun connections(): Map<Long, SocketAddress?> = peers.associate { it.id to it.address }

    // The end.

    /**
     * Shuts down: takes no more connections and requests, responds to the current ones, and closes the rest after
     * [grace].
     */
    fun stop(grace: Long, over: () -> Unit) {
        waitsForEnd.add(over)
        if (life == Life.RUNNING) life = Life.STOPPING
        val at = after(loop.now, grace)
        if (life == Life.STOPPING && at < cutOffAt) {
            cutOff?.cancel()
            cutOffAt = at
            cutOff = loop.schedule(at) { abort() }
        }
        peers.toList().forEach { it.drain() }
        dataPeers.toList().forEach { it.drain() }
        lookForEnd()
    }

    /** Ends everything at once. */
    fun abort() {
        life = Life.OVER
        breakAll()
        abandoned.toList().forEach { it.cancel() }
        abandoned.clear()
        over()
    }

    /** Breaks every connection, as a network failure does. */
    fun breakAll() {
        for (peer in peers.toList() + dataPeers.toList()) {
            leave(peer)
            peer.cut()
        }
    }

    private fun lookForEnd() {
        if (life == Life.STOPPING && peers.isEmpty() && dataPeers.isEmpty() && abandoned.isEmpty() && parting == 0) over()
    }

    private fun over() {
        life = Life.OVER
        cutOff?.cancel()
        inbox.end()
        val told = waitsForEnd.toList()
        waitsForEnd.clear()
        told.forEach { it() }
    }
}
