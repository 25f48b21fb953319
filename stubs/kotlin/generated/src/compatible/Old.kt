package old

import fc.runtime.ClientConfig
import fc.runtime.Context
import fc.runtime.Server
import fc.runtime.ServerConfig
import kotlinx.coroutines.runBlocking
import lamp.Client
import lamp.GetLightRequest
import lamp.GetLightResponse
import lamp.Lamp
import lamp.Mood
import lamp.PartialRobot
import lamp.SetLightRequest
import lamp.SetLightResponse
import lamp.service

/** A program of long ago: compiled with an older package, and run with a newer one. */
private class OldRobot : PartialRobot {
    private var mood = Mood.COLD

    override suspend fun getLight(context: Context, request: GetLightRequest): GetLightResponse =
        GetLightResponse.builder().brightness(40).mood(mood).build()

    override suspend fun setLight(context: Context, request: SetLightRequest): SetLightResponse {
        mood = request.mood ?: mood
        return SetLightResponse {}
    }
}

fun main(): Unit = runBlocking {
    val server = Server.bind(Lamp, OldRobot().service(), ServerConfig().address("127.0.0.1").commandPort(0).dataPort(0))
    Client.connect(ClientConfig().host("127.0.0.1").commandPort(server.commandAddress.port)).use { client ->
        client.setLight(SetLightRequest { brightness(80).mood(Mood.WARM) })
        val light = client.getLight()
        println("${light.brightness} ${light.mood} ${light.toBuilder().brightness(41).build().toJson()}")
    }
    server.close()
}
