/**
 * An app that tests a connection under external disturbance. It continues to read while the connection is cut, cancels
 * calls, and calls while the robot shuts down.
 */
@file:JvmName("Drill")

package fc.examples

import fc.Client
import fc.runtime.CallError
import java.util.concurrent.atomic.AtomicInteger
import kotlin.system.exitProcess
import kotlinx.coroutines.CoroutineStart
import kotlinx.coroutines.coroutineScope
import kotlinx.coroutines.launch
import kotlinx.coroutines.runBlocking

private const val USAGE = """Tries out the connection to a robot: reads while it is cut, gives calls up, calls while the robot ends.

Usage: run drill [--host 127.0.0.1] [--command-port PORT] [--gzip-from BYTES]

From `reading` on the connection may be cut; `calling` asks for the robot to be ended."""

/** Calls in flight at a time. */
private const val AT_ONCE = 64

/** Reads that must succeed although the connection is cut. */
private const val READS = 1000

internal fun main(arguments: Array<String>) {
    val told = Arguments(arguments, USAGE)
    val fault = runBlocking {
        try {
            Client.connect(told.client()).use { client ->
                say("reading")
                read(client)
                say("read: $READS answered")
                giveUp(client)
                say("given up: $AT_ONCE, and the next one answered")
            }
            // A client without reconnection: the end of the robot ends its calls.
            Client.connect(told.client().reconnect(null)).use { client ->
                say("calling")
                say("ended: ${callToTheEnd(client)} answered, $AT_ONCE lost")
            }
            null
        } catch (failure: Exception) {
            failure.message ?: failure.toString()
        }
    }
    if (fault != null) System.err.println(fault)
    exitProcess(if (fault == null) 0 else 1)
}

private fun say(line: String) {
    println(line)
    System.out.flush()
}

/** Each call is a read and is repeated after a loss, so every call succeeds. */
private suspend fun read(client: Client) {
    val left = AtomicInteger(READS)
    coroutineScope {
        repeat(AT_ONCE) {
            launch { while (left.getAndDecrement() > 0) client.getRobotSn() }
        }
    }
}

/** Sends calls and cancels them before a response can arrive. The connection remains usable. */
private suspend fun giveUp(client: Client) {
    coroutineScope {
        // Each is sent before the next one begins.
        val calls = List(AT_ONCE) { launch(start = CoroutineStart.UNDISPATCHED) { client.getRobotSn() } }
        for (call in calls) call.cancel()
    }
    client.getRobotSn()
}

/**
 * Calls until the robot has gone, and returns the number of responses. Every call ends, and the last ones report a lost
 * connection.
 */
private suspend fun callToTheEnd(client: Client): Int {
    val answered = AtomicInteger()
    coroutineScope {
        repeat(AT_ONCE) {
            launch {
                try {
                    while (true) {
                        client.getRobotSn()
                        answered.incrementAndGet()
                    }
                } catch (error: CallError) {
                    if (error.loss == null) throw error
                }
            }
        }
    }
    return answered.get()
}
